/** Which keys jog what. */
import type { Space } from '../../document/teaching'

const TOOL_KEYS: Readonly<Record<string, readonly [axis: number, direction: 1 | -1]>> = {
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowLeft: [1, 1],
  ArrowRight: [1, -1],
  PageUp: [2, 1],
  PageDown: [2, -1],
}
/** What Shift makes of the digits, on the usual layouts. */
const SHIFTED = ['!', '@', '#', '$', '%', '^', '&']

export interface JogKey {
  readonly axis: number
  readonly direction: 1 | -1
}

export function jogKey(space: Space, key: string, withShift: boolean, rows: number): JogKey | undefined {
  if (space === 'tool') {
    const found = TOOL_KEYS[key]
    return found && { axis: found[0] + (withShift ? 3 : 0), direction: found[1] }
  }
  const digit = /^[1-9]$/.test(key) ? Number(key) - 1 : SHIFTED.indexOf(key)
  return digit >= 0 && digit < rows ? { axis: digit, direction: withShift ? -1 : 1 } : undefined
}

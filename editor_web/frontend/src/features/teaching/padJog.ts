/** What the sticks of a gamepad mean for an arm, as long as its deadman button is held. */
import { MOST_M_S, MOST_RAD_S, type Space } from '../../document/teaching'

/** The upper shoulder buttons of the standard gamepad: the left one lets the arm go, the right one is as Shift. */
const DEADMAN = 4
const SHIFT = 5
/** Sticks do not come back to their middle. */
const DEAD_ZONE = 0.15
const STICKS = 4

export interface Pad {
  readonly index: number
  readonly connected: boolean
  readonly axes: readonly number[]
  readonly buttons: readonly { readonly pressed: boolean }[]
}

/** The first gamepad whose deadman button is held. */
export function heldPad(pads: readonly (Pad | null)[]): Pad | undefined {
  return pads.find((pad) => pad?.connected && pad.buttons[DEADMAN]?.pressed) ?? undefined
}

/** The gamepads, by their number, that are there with their deadman button up. */
export function releasedPads(pads: readonly (Pad | null)[]): readonly number[] {
  return pads.filter((pad): pad is Pad => pad !== null && pad.connected && !pad.buttons[DEADMAN]?.pressed).map((pad) => pad.index)
}

/** Where the arm is to go, m/s and rad/s, at `share` of full speed. */
export function padVelocity(pad: Pad, space: Space, share: number, joints: number): readonly number[] {
  const width = space === 'tool' ? 6 : joints
  const isShifted = pad.buttons[SHIFT]?.pressed ?? false
  // Left and up are the positive ways, as they are for the keys.
  const [x = 0, y = 0, x2 = 0, y2 = 0] = Array.from({ length: STICKS }, (_, at) => -beyond(pad.axes[at] ?? 0))
  const first = space === 'tool' ? (isShifted ? 3 : 0) : isShifted ? STICKS : 0
  const sticks = space === 'tool' ? [y, x, y2] : [x, y, x2, y2]
  return Array.from({ length: width }, (_, at) => {
    const full = space === 'tool' && at < 3 ? MOST_M_S : MOST_RAD_S
    // Without the minus of a zero.
    return (sticks[at - first] ?? 0) * share * full + 0
  })
}

function beyond(value: number): number {
  const far = Math.min(1, (Math.abs(value) - DEAD_ZONE) / (1 - DEAD_ZONE))
  return far > 0 ? Math.sign(value) * far : 0
}

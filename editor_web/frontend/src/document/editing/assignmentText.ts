/** Assignments to userdata as lines of text, `key: value`. Pure. */
import type { Dict } from '../dict'
import { looseValue, shownValue } from './fields'

/** A mapping of keys to values, one a line. */
export function assignedText(assigned: unknown): string {
  if (typeof assigned !== 'object' || assigned === null || Array.isArray(assigned)) return ''
  return Object.entries(assigned)
    .map(([key, value]) => `${key}: ${shownValue(value)}`)
    .join('\n')
}

/** What such lines say; a line without a colon assigns an empty text. */
export function assignments(typed: string): Dict<unknown> {
  const lines = typed.split('\n').filter((line) => line.trim() !== '')
  return Object.fromEntries(
    lines.map((line) => {
      const at = line.indexOf(':')
      return at < 0 ? [line.trim(), ''] : [line.slice(0, at).trim(), looseValue(line.slice(at + 1).trim())]
    }),
  )
}

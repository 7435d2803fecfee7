/** What was measured in a run, as marks of its timeline beside those of its events. Pure. */
import type { MeasuredMarker, TimelineMarker } from '../api/types'
import { parentPath } from './path'
import type { ShownRow } from './timeline'
import { numeral } from './values'

/** A mark of the timeline; those that were measured have a device, a value and perhaps a limit. */
export interface Mark extends TimelineMarker {
  readonly measured?: MeasuredMarker
}

/** All marks in order of time. */
export function withMeasured(marks: readonly TimelineMarker[], measured: readonly MeasuredMarker[]): readonly Mark[] {
  if (measured.length === 0) return marks
  const added = measured.map((each) => ({
    seq: each.seq,
    time_s: each.time_s,
    kind: each.kind,
    path: each.path,
    text: [each.text, valueWords(each)].filter(Boolean).join(': '),
    measured: each,
  }))
  return [...marks, ...added].toSorted((a, b) => a.time_s - b.time_s || a.seq - b.seq)
}

/** `12.5 N, limit 10 N`; empty where no number is known. */
export function valueWords({ value, limit, unit, kind }: MeasuredMarker): string {
  if (value === null) return ''
  const written = `${short(value)} ${unit}`
  if (limit === null) return written
  return `${written}, ${kind === 'grasp' || kind === 'contact' ? 'asked for' : 'limit'} ${short(limit)} ${unit}`
}

/** What stands beside the mark in its lane: `Contact 12.5 N`. */
export function laneWords(word: string, { value, unit }: MeasuredMarker): string {
  return value === null ? word : `${word} ${short(value)} ${unit}`
}

/** The row in which a mark stands: that of its node, or of what it is inside of where that is folded; -1 for none. */
export function rowOf(rows: readonly ShownRow[], path: string): number {
  const places = new Map(rows.map((row, index) => [row.path, index]))
  for (let at: string | undefined = path; at; at = parentPath(at)) {
    const index = places.get(at)
    if (index !== undefined) return index
  }
  return -1
}

/** What is as good as nothing is 0. */
function short(value: number): string {
  return Math.abs(value) < 1e-3 ? '0' : numeral(Number(value.toPrecision(3)))
}

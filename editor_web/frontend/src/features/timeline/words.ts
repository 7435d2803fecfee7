/** What the pointer is at, in words. Pure. */
import type { ActivationInterval } from '../../api/types'
import type { Mark } from '../../document/measured'
import { MARK_WORDS, placeWords, type MarkKind } from '../../document/timeline'
import { duration } from '../../document/time'

/** As near as times are told. */
const SAME_S = 0.005

const KINDS: Partial<Record<string, string>> = {
  failure: 'Failure',
  goal: 'Goal',
  gate: 'Waits',
  command: 'Operator',
  fault: 'Fault',
  change: 'Changed',
  contact: 'Contact',
  grasp: 'Grasp',
  force: 'Force',
  limit: 'Limit',
}

/** One mark of this kind, in one word. */
export function kindWord(kind: string): string {
  return KINDS[kind] ?? MARK_WORDS[kind as MarkKind]
}

export function markWords(mark: Mark): string {
  const where = mark.path ? `${mark.path}: ` : ''
  const kind = kindWord(mark.kind)
  const text = mark.text.length > 140 ? `${mark.text.slice(0, 140)}…` : mark.text
  return `${mark.time_s.toFixed(2)} s · ${kind} · ${where}${text}`
}

/** Where the cursor is, and what was measured there, for those who do not see the lanes. */
export function momentWords(timeS: number, durationS: number, marks: readonly Mark[]): string {
  const here = marks.filter((mark) => mark.measured && Math.abs(mark.time_s - timeS) < SAME_S)
  return [placeWords(timeS, durationS), ...here.map((mark) => `${kindWord(mark.kind)}: ${mark.text}`)].join(', ')
}

export function spanWords(path: string, span: ActivationInterval, nowS: number): readonly string[] {
  const end = span.end_s ?? nowS
  const how = [span.status, span.outcome].filter((word, index, all) => word && all.indexOf(word) === index).join(': ')
  const many = span.count > 1 ? `${span.count} visits, the worst of them ${how}` : how
  const visit = span.count === 1 && span.visit > 1 ? ` · visit ${span.visit}` : ''
  return [
    path,
    `${many}${visit}`,
    `${span.start_s.toFixed(2)} s to ${span.end_s === null ? 'now' : `${end.toFixed(2)} s`}, ${duration(end - span.start_s)}`,
  ]
}

/** What the pointer is at, in words. Pure. */
import type { ActivationInterval, TimelineMarker } from '../../api/types'
import { MARK_WORDS, type MarkKind } from '../../document/timeline'
import { duration } from '../../document/time'

const KINDS: Partial<Record<string, string>> = {
  failure: 'Failure',
  goal: 'Goal',
  gate: 'Waits',
  command: 'Operator',
  fault: 'Fault',
  change: 'Changed',
}

export function markWords(mark: TimelineMarker): string {
  const where = mark.path ? `${mark.path}: ` : ''
  const kind = KINDS[mark.kind] ?? MARK_WORDS[mark.kind as MarkKind]
  const text = mark.text.length > 140 ? `${mark.text.slice(0, 140)}…` : mark.text
  return `${mark.time_s.toFixed(2)} s · ${kind} · ${where}${text}`
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

/** Curves of one or two recorded runs over one time, as they are drawn. Pure. */
import { Curves } from '../../document/curves'
import type { View } from '../../document/timeline'
import type { RecordedCurves, TopicFields } from '../../api/types'

/** A recorded run, and the time of its clock that is 0 in the plot. */
export interface RecordedSource {
  readonly address: string
  /** Which of two it is; empty where there is one. */
  readonly label: string
  readonly startS: number
}

/** How a curve of a source is named. */
export function curveId(source: RecordedSource, field: string): string {
  return source.label ? `${source.label} ${field}` : field
}

/** The curves of all sources; each was asked for over the same time, so that their rows lie at the same times. */
export function joined(sources: readonly RecordedSource[], found: readonly RecordedCurves[]): Curves {
  const [first] = found
  const rows = first?.times_s.length ?? 0
  const curves = new Curves(Math.max(1, rows))
  const columns = found.flatMap((each, index) => {
    const source = sources[index]
    return source ? each.fields.map((field, at) => ({ id: curveId(source, field), values: each.columns[at] ?? [] })) : []
  })
  curves.choose(columns.map((column) => column.id))
  const startS = sources[0]?.startS ?? 0
  for (let row = 0; row < rows; row += 1) {
    curves.push(
      (first?.times_s[row] ?? 0) - startS,
      columns.map((column) => column.values[row] ?? null),
    )
  }
  return curves
}

/** The numbers that all recordings have. */
export function common(all: readonly (readonly TopicFields[])[]): readonly TopicFields[] {
  const [first, ...others] = all
  return (first ?? []).flatMap((topic) => {
    const fields = topic.fields.filter((field) =>
      others.every((other) => other.some((each) => each.topic === topic.topic && each.fields.some((known) => known.path === field.path))),
    )
    return fields.length > 0 ? [{ ...topic, fields }] : []
  })
}

const LEAST_STEP_S = 2
const STEPS = 40

/** The part of a run that goes on which is asked for: it grows in steps, for each of them reads the recording anew. */
export function settledPart(view: View, durationS: number): View {
  const stepS = 2 ** Math.ceil(Math.log2(Math.max(LEAST_STEP_S, durationS / STEPS)))
  return view.untilS < durationS ? view : { fromS: view.fromS, untilS: Math.max(view.fromS + 1e-3, Math.floor(durationS / stepS) * stepS) }
}

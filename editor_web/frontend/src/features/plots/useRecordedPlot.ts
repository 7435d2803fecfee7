/** The recorded curves that are chosen, as they are drawn and saved, wherever they stand in the page. */
import { useMemo, useState } from 'react'
import type { TopicFields } from '../../api/types'
import { csvOf, type Curves } from '../../document/curves'
import type { View } from '../../document/timeline'
import { saveBlob } from '../../components/saveBlob'
import { headingsOf } from './exporting'
import { coloured, describe } from './fields'
import { keepFields, keptFields } from './keptFields'
import type { LegendEntry } from './Legend'
import { curveId, type RecordedSource } from './recorded'
import { useRecordedCurves, useRecordedFields } from './useRecordedCurves'

export interface RecordedPlot {
  readonly topics: readonly TopicFields[] | undefined
  /** Why there are none. */
  readonly problem: string
  /** Those of the chosen numbers that were recorded. */
  readonly chosen: readonly string[]
  readonly choose: (fields: readonly string[]) => void
  /** Undefined for two sources: their curves go together. */
  readonly remove: ((id: string) => void) | undefined
  readonly curves: Curves
  readonly entries: readonly LegendEntry[]
  readonly saveCsv: () => void
}

/** Colours of the second source are those of the first, dashed. */
const DASHED = 8
const MOST_CELLS = 1000

export function useRecordedPlot(sources: readonly RecordedSource[], isShown: boolean, view: View, width: number): RecordedPlot {
  const { topics, problem } = useRecordedFields(sources, isShown)
  const [kept, setKept] = useState(keptFields)
  const chosen = useMemo(
    () => kept.filter((id) => topics?.some((topic) => topic.fields.some((field) => `${topic.topic}:${field.path}` === id))),
    [kept, topics],
  )
  const asked = Math.min(MOST_CELLS, Math.round(width / 2))
  const { curves, problem: lost } = useRecordedCurves(sources, isShown ? chosen : [], view, asked)
  const entries = useMemo(() => {
    const colors = coloured(new Map(), chosen)
    return chosen.flatMap((field) =>
      sources.map((source, index) => {
        const { topic, label, unit } = describe(field, topics ?? [])
        return {
          id: curveId(source, field),
          topic,
          label: source.label ? `${source.label} ${label}` : label,
          unit,
          color: ((colors.get(field) ?? 0) % DASHED) + (index > 0 ? DASHED : 0),
        }
      }),
    )
  }, [chosen, sources, topics])

  function choose(fields: readonly string[]): void {
    setKept(fields)
    keepFields(fields)
  }

  return {
    topics,
    problem: problem || lost,
    chosen,
    choose,
    remove: sources.length === 1 ? (id) => choose(kept.filter((each) => each !== id)) : undefined,
    curves,
    entries,
    saveCsv: () => saveBlob(new Blob([csvOf(curves, headingsOf(entries))], { type: 'text/csv' }), 'recorded-curves.csv'),
  }
}

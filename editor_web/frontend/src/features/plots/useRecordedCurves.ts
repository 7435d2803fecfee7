/** What can be drawn of recorded runs, and the curves that are chosen, asked for anew for each part of the time. */
import { useDebouncedValue } from '@mantine/hooks'
import { queryOptions } from '@tanstack/react-query'
import { useMemo } from 'react'
import { useAnswer, useLastAnswer } from '../../api/queryClient'
import { queryKeys } from '../../api/queryKeys'
import { curvesOfAll, recordedQueries, type AskedCurves } from '../../api/recordedCurves'
import type { TopicFields } from '../../api/types'
import { Curves } from '../../document/curves'
import type { View } from '../../document/timeline'
import { common, joined, type RecordedSource } from './recorded'

const PATIENCE_MS = 120
const KEPT_MS = 30_000

export function useRecordedFields(
  sources: readonly RecordedSource[],
  isShown: boolean,
): { readonly topics: readonly TopicFields[] | undefined; readonly problem: string } {
  const { value, problem = '' } = useAnswer({ ...recordedQueries.fields(sources.map((source) => source.address)), enabled: isShown })
  const topics = useMemo(() => value && common(value.map((each) => each.topics)), [value])
  return { topics, problem }
}

const NONE = new Curves(1)

interface Asked extends AskedCurves {
  readonly sources: readonly RecordedSource[]
}

/** Undefined fields until the first answer; what was drawn stays until the next one has come. */
export function useRecordedCurves(
  sources: readonly RecordedSource[],
  chosen: readonly string[],
  view: View,
  cells: number,
): { readonly curves: Curves; readonly problem: string } {
  const asked: Asked = { sources, fields: chosen, fromS: view.fromS, untilS: view.untilS, cells }
  const [key] = useDebouncedValue(JSON.stringify(asked), PATIENCE_MS)
  const { value, problem = '' } = useLastAnswer(curvesQuery(JSON.parse(key) as Asked))
  return { curves: value ?? NONE, problem }
}

function curvesQuery(asked: Asked) {
  return queryOptions({
    queryKey: queryKeys.recordedCurves(asked),
    queryFn: async () => joined(asked.sources, await curvesOfAll(asked)),
    enabled: asked.fields.length > 0 && asked.cells >= 1,
    // Thousands of numbers are neither compared with those of before nor kept for long.
    structuralSharing: false,
    gcTime: KEPT_MS,
  })
}

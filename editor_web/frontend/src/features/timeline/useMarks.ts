/** What was measured in the run of the timeline; while it goes on, asked for again and again. */
import { skipToken, useQuery } from '@tanstack/react-query'
import { useMemo } from 'react'
import { pastQueries, runSubject, type Subject } from '../../api/timeline'
import type { MeasuredMarkers, TimelineMarker } from '../../api/types'
import { withMeasured, type Mark } from '../../document/measured'

const AGAIN_MS = 2000
const NO_MARKS: readonly TimelineMarker[] = []

/** All marks of a run; `measured` is undefined until the server has answered, and where it cannot. */
export function useMarks(
  subject: Subject | undefined,
  events: readonly TimelineMarker[] = NO_MARKS,
  isShown: boolean,
  isGoingOn: boolean,
): { readonly marks: readonly Mark[]; readonly measured: MeasuredMarkers | undefined } {
  const query = pastQueries.measured(subject ?? runSubject(''), !isGoingOn)
  const { data } = useQuery({
    ...query,
    ...(subject && isShown ? {} : { queryFn: skipToken }),
    staleTime: isGoingOn ? 0 : Infinity,
    refetchInterval: isGoingOn && isShown && AGAIN_MS,
  })
  const marks = useMemo(() => withMeasured(events, data?.marks ?? []), [events, data])
  return { marks, measured: data }
}

/** The userdata of the moment of the past that is shown. */
import { skipToken, useQuery } from '@tanstack/react-query'
import { useState } from 'react'
import { useLive } from './live'
import { problemOf } from './queryClient'
import { pastQueries, runSubject, useTimeline, type Subject } from './timeline'
import type { PastUserdata, Watch } from './types'

interface Moment {
  readonly subject: Subject
  readonly seq: number
}

/** Undefined while the present is shown; kept up with the cursor, one request at a time. */
export function usePastValues(run: string | undefined, isShown: boolean, watches: readonly Watch[]): PastUserdata | undefined {
  const seq = useLive((s) => s.past?.seq)
  const opened = useTimeline((s) => s.opened)
  const subject = opened ?? (run ? runSubject(run) : undefined)
  const [asked, ask] = useState<Moment>()
  const query = pastQueries.userdata(asked?.subject ?? runSubject(''), asked?.seq ?? 0, watches)
  const { data, error, isFetching } = useQuery({ ...query, ...(!asked && { queryFn: skipToken }) })
  const isOther = asked?.seq !== seq || asked?.subject.address !== subject?.address
  if (isShown && !isFetching && isOther && seq !== undefined && subject) ask({ subject, seq })
  const [latest, setLatest] = useState<Moment & { readonly values: PastUserdata; readonly watches: readonly Watch[] }>()
  const problem = problemOf(error)
  const values = problem === undefined ? data : { seq: asked?.seq ?? 0, scopes: {}, watches: [], problem }
  const isLatest =
    latest?.subject === asked?.subject &&
    latest?.seq === asked?.seq &&
    latest?.watches === watches &&
    latest.values.problem === values?.problem
  if (asked && values && !isLatest) setLatest({ ...asked, values, watches })
  if (seq === undefined) return undefined
  // Of another time than the one that is shown, until that has come; never of another run.
  return latest && latest.subject.address === subject?.address ? latest.values : { seq, scopes: {}, watches: [], problem: '' }
}

/** The failure of a run, and how the run differs from the last one of its behavior that succeeded. */
import { skipToken } from '@tanstack/react-query'
import { comparisonQueries } from '../../api/comparison'
import { useAnswer } from '../../api/queryClient'
import { pastQueries, runSubject, type Subject } from '../../api/timeline'
import type { RunComparison, RunFailure } from '../../api/types'

export interface FoundFailure {
  /** Undefined until the server has answered. */
  readonly failure: RunFailure | null | undefined
  readonly problem: string
}

export function useFailure(subject: Subject | undefined, isOver: boolean): FoundFailure {
  const isAsked = subject !== undefined && isOver
  const query = pastQueries.failure(subject ?? runSubject(''))
  const { value, problem } = useAnswer({ ...query, ...(!isAsked && { queryFn: skipToken }) })
  if (!isAsked) return { failure: undefined, problem: '' }
  return problem === undefined ? { failure: value, problem: '' } : { failure: null, problem }
}

/** Undefined until it is known; null where no earlier run succeeded, or the run is in no journal. */
export function useLastGoodRun(run: string, hasFailed: boolean): RunComparison | null | undefined {
  const { value, problem } = useAnswer({ ...comparisonQueries.againstLastGood(run), enabled: hasFailed })
  if (!hasFailed) return undefined
  return problem === undefined ? value : null
}

/** The failure of a run, and how the run differs from the last one of its behavior that succeeded. */
import { useEffect, useState } from 'react'
import { call, wordsOf } from '../../api/client'
import { pastApi, type Subject } from '../../api/timeline'
import type { PastRun, RunComparison, RunFailure } from '../../api/types'

export interface FoundFailure {
  /** Undefined until the server has answered. */
  readonly failure: RunFailure | null | undefined
  readonly problem: string
}

const WAITING: FoundFailure = { failure: undefined, problem: '' }

export function useFailure(subject: Subject | undefined, isOver: boolean): FoundFailure {
  const [found, setFound] = useState(WAITING)
  useEffect(() => {
    setFound(WAITING)
    if (!subject || !isOver) return
    let isCurrent = true
    pastApi.failure(subject).then(
      (failure) => isCurrent && setFound({ failure, problem: '' }),
      (error: unknown) => isCurrent && setFound({ failure: null, problem: wordsOf(error) }),
    )
    return () => {
      isCurrent = false
    }
  }, [subject, isOver])
  return found
}

/** Undefined until it is known; null where no earlier run succeeded, or the run is in no journal. */
export function useLastGoodRun(run: string, hasFailed: boolean): RunComparison | null | undefined {
  const [found, setFound] = useState<{ readonly run: string; readonly comparison: RunComparison | null }>()
  useEffect(() => {
    if (!hasFailed) return
    let isCurrent = true
    againstLastGood(run).then(
      (comparison) => isCurrent && setFound({ run, comparison }),
      () => isCurrent && setFound({ run, comparison: null }),
    )
    return () => {
      isCurrent = false
    }
  }, [run, hasFailed])
  return found?.run === run ? found.comparison : undefined
}

async function againstLastGood(run: string): Promise<RunComparison | null> {
  const good = await call<PastRun | null>(`/runs/${encodeURIComponent(run)}/last-good-run`)
  return good && call<RunComparison>(`/past-runs/comparison?${new URLSearchParams({ left: good.id, right: run }).toString()}`)
}

/** How far a run is shrunk, as the server tells it; asked again as long as it goes on. */
import { useCallback, useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
import { sweepsApi } from '../../api/sweeps'
import type { Shrinking } from '../../api/types'

const PERIOD_MS = 1000

export interface RunShrinking {
  readonly shrinking: Shrinking | undefined
  /** Why the last request was refused. */
  readonly problem: string
  /** Ask for something, and then how far it is. */
  readonly request: (asked: () => Promise<unknown>) => Promise<void>
}

export function useShrinking(sweep: string, number: number): RunShrinking {
  const [shrinking, setShrinking] = useState<Shrinking>()
  const [problem, setProblem] = useState('')
  const [revision, setRevision] = useState(0)
  useEffect(() => {
    let isCurrent = true
    sweepsApi.shrinking(sweep, number).then(
      (current) => isCurrent && setShrinking(current),
      (error: unknown) => isCurrent && setProblem(wordsOf(error)),
    )
    return () => {
      isCurrent = false
    }
  }, [sweep, number, revision])
  useEffect(() => {
    if (!shrinking || shrinking.status === 'idle') return
    const timer = setTimeout(() => setRevision((before) => before + 1), PERIOD_MS)
    return () => clearTimeout(timer)
  }, [shrinking])
  const request = useCallback(async (asked: () => Promise<unknown>) => {
    setProblem('')
    try {
      await asked()
      setRevision((before) => before + 1)
    } catch (error) {
      setProblem(wordsOf(error))
    }
  }, [])
  return { shrinking, problem, request }
}

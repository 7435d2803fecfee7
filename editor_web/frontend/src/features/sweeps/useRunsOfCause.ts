/** Which runs are shown: all, or those with the cause that is chosen. */
import { useMemo, useState } from 'react'
import type { SweepRuns, TrialResult } from '../../api/types'
import { alikeOf } from '../../document/sweeps'

export interface RunsOfCause {
  /** An example of the chosen cause; undefined without one, or where it has no run any more. */
  readonly cause: number | undefined
  readonly shown: readonly TrialResult[]
  /** The factors of the runs without `seed`, which is none that one looks at first. */
  readonly factors: readonly string[]
  readonly choose: (example: number | undefined) => void
}

export function useRunsOfCause(runs: SweepRuns): RunsOfCause {
  const [cause, choose] = useState<number>()
  const alike = useMemo(() => alikeOf(runs, cause), [runs, cause])
  const shown = useMemo(() => (alike.size > 0 ? runs.runs.filter((run) => alike.has(run.configuration.number)) : runs.runs), [runs, alike])
  const factors = useMemo(() => Object.keys(runs.runs[0]?.configuration.values ?? {}).filter((address) => address !== 'seed'), [runs])
  return { cause: alike.size > 0 ? cause : undefined, shown, factors, choose }
}

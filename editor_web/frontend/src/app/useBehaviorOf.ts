/** The behavior of a run as it runs: fetched again when the run goes on with another version of it. */
import { api } from '../api/client'
import { useLive } from '../api/live'
import type { BehaviorView, RunView } from '../api/types'
import { useFetched, type Fetched } from './useFetched'

/** Of the run that is shown here. */
export function useBehaviorOf(run: RunView): Fetched<BehaviorView> {
  const changedAt = useLive((s) => s.log.findLast((line) => line.kind === 'behavior_changed')?.seq ?? 0)
  return useFetched(run.behavior, () => api.behavior(run.behavior), changedAt)
}

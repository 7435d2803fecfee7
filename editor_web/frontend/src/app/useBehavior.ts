/** A behavior as it runs: asked for again when the run that is shown here goes on with another version of it. */
import { behaviorQueries } from '../api/behaviorQueries'
import { useLive } from '../api/live'
import { useAnswer, useOutdated, type Answer } from '../api/queryClient'
import { queryKeys } from '../api/queryKeys'
import type { BehaviorView } from '../api/types'

export function useBehavior(id: string): Answer<BehaviorView> {
  const changedAt = useLive((s) => s.log.findLast((line) => line.kind === 'behavior_changed')?.seq ?? 0)
  useOutdated(queryKeys.behavior(id), changedAt)
  return useAnswer(behaviorQueries.one(id))
}

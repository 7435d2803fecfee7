/** Why a run of a behavior cannot be started now, in words. Pure. */
import type { BehaviorView, CellStop, RunView, SessionBody } from '../api/types'
import { isError } from './editing/findings'

export function hasErrors(behavior: Pick<BehaviorView, 'findings'>): boolean {
  return behavior.findings.some(isError)
}

export function startObstacle(
  behavior: Pick<BehaviorView, 'id' | 'findings' | 'fit'>,
  active: readonly Pick<RunView, 'behavior'>[],
  session: Pick<SessionBody, 'role'> | undefined,
  stop: Pick<CellStop, 'phase'> | null,
): string | undefined {
  if (session && session.role !== 'operator') return 'You may look only: log in with the operator token to start runs'
  if (hasErrors(behavior)) return 'The document has errors; see its problems'
  if (behavior.fit.obstacle) return `It cannot be started here: ${behavior.fit.obstacle}`
  if (stop && stop.phase !== 'released') return 'The cell is stopped: release the stop in the recovery guide first'
  return active.some((run) => run.behavior === behavior.id) ? 'A run of this behavior is active' : undefined
}

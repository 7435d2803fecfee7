/** How a run is to be watched over from its start. Pure. */
import type { StartBody } from '../api/types'
import type { Level } from './commands'

export type LossPolicy = 'hold' | 'continue' | 'stop'

export interface Supervision {
  readonly autonomy: Level
  /** Whether the page that starts the run is its operator. */
  readonly operates: boolean
  readonly demandsOperator: boolean
  readonly startsPaused: boolean
  readonly usesBreakpoints: boolean
  readonly lossPolicy: LossPolicy
  readonly lossTimeoutS: number
}

export const SUPERVISION: Supervision = {
  autonomy: 'full',
  operates: false,
  demandsOperator: false,
  startsPaused: false,
  usesBreakpoints: true,
  lossPolicy: 'hold',
  lossTimeoutS: 5,
}

/** With another autonomy: below full somebody has to be there to be asked. */
export function withAutonomy(supervision: Supervision, autonomy: Level): Supervision {
  return { ...supervision, autonomy, operates: supervision.operates || autonomy !== 'full' }
}

/**
 * The request. Breakpoints are asked for only where there are any. A run that this page operates begins paused,
 * and goes on once the page is its operator.
 */
export function supervisionOf(given: Supervision, hasBreakpoints: boolean): Pick<StartBody, 'supervision' | 'breakpoints'> {
  return {
    supervision: {
      autonomy: given.autonomy,
      demand_operator: given.demandsOperator,
      start_paused: given.startsPaused || given.operates,
      loss_policy: given.lossPolicy,
      loss_timeout_s: given.lossTimeoutS,
    },
    breakpoints: given.usesBreakpoints && hasBreakpoints,
  }
}

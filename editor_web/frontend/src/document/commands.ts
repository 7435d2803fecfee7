/** Which commands a run takes now, and in words why it does not take the others. Pure. */
import type { ControlView, RunView, GateWait } from '../api/types'
import { isActive } from './runState'

export const LEVELS = ['off', 'low', 'high', 'full'] as const
export type Level = (typeof LEVELS)[number]

/** What a level of autonomy means, for an outcome that names what it requires. */
export const LEVEL_WORDS: Record<Level, string> = {
  off: 'every outcome asks',
  low: 'outcomes that require low, high or full ask',
  high: 'outcomes that require high or full ask',
  full: 'only outcomes that require full autonomy ask',
}

export type Command =
  | 'pause'
  | 'resume'
  | 'step'
  | 'back'
  | 'stop'
  | 'autonomy'
  | 'operate'
  | 'change'
  | 'lock'
  | 'force'
  | 'repeat'
  | 'breakpoint'
  | 'userdata'

export interface Situation {
  readonly role: string
  readonly isConnected: boolean
  readonly run: RunView | undefined
  readonly control: ControlView | null
  /** Path of the selected node. */
  readonly node: string | undefined
  readonly nodeStatus: string
}

/** Why a command is not possible now; undefined when it is. */
export function disabledReason(command: Command, now: Situation): string | undefined {
  const { control, node, run } = now
  if (!now.isConnected) return 'the server does not answer'
  if (now.role !== 'operator') return 'you may look only; log in with the operator token'
  if (command === 'breakpoint') return node ? undefined : 'select a node in the graph first'
  if (!run || !isActive(run) || !control) return 'no run is active'
  if (run.status === 'stopping') return 'the run is stopping'
  switch (command) {
    case 'pause':
      return control.paused && !control.stepping ? 'the run is paused' : undefined
    case 'resume':
    case 'step':
      return control.paused ? undefined : 'pause the run first'
    case 'back':
    case 'userdata':
      if (!control.paused) return 'pause the run first'
      return control.stepping ? 'the run is stepping' : undefined
    case 'change':
      return control.paused || control.locks.length > 0 ? undefined : 'pause the run first'
    case 'lock':
      return node ? undefined : 'select a node in the graph first'
    case 'force':
    case 'repeat':
      return obstacleToOrder(now)
    default:
      return undefined
  }
}

function obstacleToOrder({ control, node, nodeStatus }: Situation): string | undefined {
  if (!node) return 'select a node in the graph first'
  const waits = control?.waiting.some((each) => each.path === node)
  return waits || nodeStatus === 'active' ? undefined : 'this node is not active'
}

const REASONS: Record<string, string> = { pause: 'paused', lock: 'locked', autonomy: 'asks for your agreement' }

/** `before its entry: paused`, `with held: locked`. */
export function waitingWords({ point, outcome, reasons }: GateWait): string {
  const place = point === 'before' ? 'before its entry' : outcome ? `with ${outcome}` : 'after its end'
  return `${place}: ${reasons.map((reason) => REASONS[reason] ?? `held by ${reason}`).join(', ')}`
}

const LOSSES: Record<string, string> = {
  hold: 'the run is paused',
  continue: 'the run goes on without questions',
  stop: 'the run is stopped',
}

/** What becomes of a run whose operator is lost. */
function lossWords({ loss_policy: policy, loss_timeout_s: after }: ControlView): string {
  return `${after > 0 ? `${after} s later ` : ''}${LOSSES[policy] ?? policy}`
}

/** What is known of the operator, in words; `isMine` when this page is one. */
export function operatorWords(control: ControlView, isMine: boolean): string {
  if (control.operator === 'lost') return `The operator was lost: ${lossWords(control)}`
  if (isMine) return `You operate this run. If this page is lost, ${lossWords(control)}.`
  if (control.operator === 'attached') return 'Another page or console operates this run.'
  return control.demanded ? 'This run has no operator, but demands one: it asks anyway.' : 'This run has no operator: it asks nothing.'
}

/** The state of a run in one word, why it is so, and its look: the only place where they are made. Pure. */
import type { ControlView, GateWait, RunView } from '../api/types'
import { matches } from './breakpoints'
import { nameOfPath } from './path'

/** A colour and an icon, of runs and of nodes. */
export type Status = 'idle' | 'active' | 'done' | 'failed' | 'stopped' | 'skipped' | 'warning' | 'paused' | 'waiting' | 'locked'

export interface RunState {
  readonly word: string
  readonly look: Status
  /** What there is to add to the word; empty where there is nothing. */
  readonly reason: string
}

/** What is known of a run, under way or over. */
export type RunFacts = Pick<RunView, 'status'> & Partial<Pick<RunView, 'outcome' | 'success' | 'waits' | 'cause'>>

/** Outcomes that say no more than that a run has ended well or badly. */
const PLAIN_OUTCOMES = new Set(['done', 'finished', 'succeeded', 'success', 'failed', 'failure', 'error'])

/** Is this run still going? */
export function isActive(run: RunFacts | undefined): boolean {
  return run?.status === 'running' || run?.status === 'stopping'
}

/** Did it end badly? */
export function isFailed(run: RunFacts): boolean {
  return run.status === 'errored' || (run.status === 'finished' && !run.success)
}

/** The questions of a run to its operator. */
export function requestsOf(control: ControlView | null): readonly GateWait[] {
  return control?.waiting.filter((each) => each.reasons.includes('autonomy')) ?? []
}

/** The state of a run; `control` is that of the run that is watched, and tells more. */
export function runStateOf(run: RunFacts | undefined, control: ControlView | null = null): RunState {
  if (!run) return { word: 'No run', look: 'idle', reason: '' }
  switch (run.status) {
    case 'running':
      return control ? watched(control) : unwatched(run.waits ?? '')
    case 'stopping':
      return { word: 'Stopping', look: 'stopped', reason: 'states clean up, robots come to rest' }
    case 'stopped':
      return { word: 'Stopped', look: 'stopped', reason: run.cause ?? '' }
    case 'interrupted':
      return { word: 'Interrupted', look: 'warning', reason: 'its engine ended before the run' }
    default:
      return isFailed(run)
        ? { word: 'Failed', look: 'failed', reason: ownCause(run.cause ?? '') }
        : { word: 'Succeeded', look: 'done', reason: '' }
  }
}

/** A cause without the name of its run, which is as long as a line and is the run that is shown. */
function ownCause(cause: string): string {
  return cause.replace(/^run \S+ at /, '')
}

/** The word, with the outcome where it says more: `Failed: no_part`. */
export function runWords(run: RunFacts | undefined, control: ControlView | null = null): string {
  const { word } = runStateOf(run, control)
  const outcome = run && !isActive(run) ? (run.outcome ?? '') : ''
  return outcome && !PLAIN_OUTCOMES.has(outcome) ? `${word}: ${outcome}` : word
}

function unwatched(waits: string): RunState {
  switch (waits) {
    case 'asks':
      return { word: 'Waiting for answer', look: 'waiting', reason: '' }
    case 'paused':
      return { word: 'Paused', look: 'paused', reason: '' }
    case 'locked':
      return { word: 'Waiting at lock', look: 'locked', reason: '' }
    default:
      return { word: 'Running', look: 'active', reason: '' }
  }
}

function watched(control: ControlView): RunState {
  const asked = requestsOf(control).length
  if (control.stepping) return { word: 'Stepping', look: 'active', reason: 'to the next stop' }
  if (control.paused && !control.confirmed) return { word: 'Pausing', look: 'paused', reason: 'motions come to rest' }
  if (control.paused) return { word: 'Paused', look: 'paused', reason: pauseReason(control) }
  if (asked > 0) return { word: 'Waiting for answer', look: 'waiting', reason: asked === 1 ? '' : `${asked} questions` }
  const locked = control.waiting.find((each) => each.reasons.includes('lock'))
  return locked
    ? { word: 'Waiting at lock', look: 'locked', reason: nameOfPath(locked.path) }
    : { word: 'Running', look: 'active', reason: '' }
}

/** `breakpoint at grasp`, where it is known to be one. */
function pauseReason(control: ControlView): string {
  const atBreakpoint = control.waiting.find(
    (wait) =>
      wait.reasons.includes('pause') &&
      control.breakpoints.some((each) => (each.enabled ?? true) && (each.when ?? 'before') === wait.point && matches(each.path, wait.path)),
  )
  const where = atBreakpoint ? `breakpoint at ${nameOfPath(atBreakpoint.path)}` : 'everything is at rest'
  return control.cannot.length > 0 ? `cannot be held: ${control.cannot.join(', ')}` : where
}

const NODE_WORDS: Readonly<Record<string, string>> = {
  idle: 'Not entered',
  active: 'Active',
  done: 'Done',
  failed: 'Failed',
  stopped: 'Stopped',
  skipped: 'Skipped',
}

/** The state of a node in one word, with its outcome where it has one. */
export function nodeWords(status: string, outcome = ''): string {
  const word = NODE_WORDS[status] ?? status
  return outcome && outcome !== status ? `${word}: ${outcome}` : word
}

/** The look of a node's status, and of the severity of a finding. */
export function statusOf(word: string): Status {
  switch (word) {
    case 'active':
    case 'done':
    case 'failed':
    case 'stopped':
    case 'skipped':
    case 'warning':
      return word
    case 'error':
      return 'failed'
    default:
      return 'idle'
  }
}

/** Which commands are possible, and why not. */
import { describe, expect, it } from 'vitest'
import type { ControlView, RunView, GateWait } from '../api/types'
import { disabledReason, operatorWords, waitingWords, type Command, type Situation } from './commands'

const run: RunView = {
  id: 'r',
  behavior: 'b',
  status: 'running',
  outcome: null,
  success: false,
  cause: '',
  started_at_s: 0,
  duration_s: 0,
  waits: '',
  ticking: false,
}
const control: ControlView = {
  paused: false,
  confirmed: false,
  stepping: false,
  cannot: [],
  active: [],
  waiting: [],
  locks: [],
  breakpoints: [],
  autonomy: 'full',
  operator: 'none',
  demanded: false,
  loss_policy: 'hold',
  loss_timeout_s: 5,
}
const now: Situation = { role: 'operator', isConnected: true, run, control, node: undefined, nodeStatus: 'idle' }
const asks: GateWait = { path: 'root/a', visit: 1, point: 'after', outcome: 'held', required: 'high', reasons: ['autonomy'] }

describe('a command', () => {
  it.each<[Command, Partial<Situation>, string | undefined]>([
    ['pause', {}, undefined],
    ['pause', { role: 'viewer' }, 'you may look only; log in with the operator token'],
    ['pause', { isConnected: false }, 'the server does not answer'],
    ['pause', { run: undefined, control: null }, 'no run is active'],
    ['pause', { run: { ...run, status: 'stopping' } }, 'the run is stopping'],
    ['pause', { control: { ...control, paused: true } }, 'the run is paused'],
    ['pause', { control: { ...control, paused: true, stepping: true } }, undefined],
    ['step', {}, 'pause the run first'],
    ['step', { control: { ...control, paused: true } }, undefined],
    ['back', {}, 'pause the run first'],
    ['back', { control: { ...control, paused: true } }, undefined],
    ['back', { control: { ...control, paused: true, stepping: true } }, 'the run is stepping'],
    ['change', {}, 'pause the run first'],
    ['change', { control: { ...control, locks: ['root'] } }, undefined],
    ['lock', {}, 'select a node in the graph first'],
    ['lock', { node: 'root/a' }, undefined],
    ['force', { node: 'root/a' }, 'this node is not active'],
    ['force', { node: 'root/a', nodeStatus: 'active' }, undefined],
    ['force', { node: 'root/a', control: { ...control, waiting: [asks] } }, undefined],
    ['breakpoint', { node: 'root/a', run: undefined, control: null }, undefined],
  ])('%s with %j: %s', (command, given, expected) => {
    expect(disabledReason(command, { ...now, ...given })).toBe(expected)
  })
})

describe('the words of a run', () => {
  it('says where a node waits and for what', () => {
    expect(waitingWords(asks)).toBe('with held: asks for your agreement')
    expect(waitingWords({ ...asks, point: 'before', outcome: '', reasons: ['pause', 'lock'] })).toBe('before its entry: paused, locked')
  })

  it('says what becomes of the run when the page is lost', () => {
    expect(operatorWords({ ...control, operator: 'attached' }, true)).toContain('5 s later the run is paused')
    expect(operatorWords({ ...control, operator: 'lost', loss_policy: 'stop', loss_timeout_s: 0 }, false)).toBe(
      'The operator was lost: the run is stopped',
    )
  })
})

/** One word for each state of a run, wherever it is shown. */
import { describe, expect, it } from 'vitest'
import type { ControlView, GateWait, RunView } from '../api/types'
import { isFailed, nodeWords, requestsOf, runStateOf, runWords } from './runState'

function run(told: Partial<RunView> = {}): RunView {
  return {
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
    ...told,
  }
}

function control(told: Partial<ControlView> = {}): ControlView {
  return {
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
    ...told,
  }
}

function asks(path: string, told: Partial<GateWait> = {}): GateWait {
  return { path, visit: 1, point: 'after', outcome: 'held', required: 'high', reasons: ['autonomy'], ...told }
}

describe('the state of a run', () => {
  it.each<[Partial<RunView>, string, string]>([
    [{}, 'Running', 'active'],
    [{ waits: 'asks' }, 'Waiting for answer', 'waiting'],
    [{ waits: 'paused' }, 'Paused', 'paused'],
    [{ waits: 'locked' }, 'Waiting at lock', 'locked'],
    [{ status: 'stopping' }, 'Stopping', 'stopped'],
    [{ status: 'stopped' }, 'Stopped', 'stopped'],
    [{ status: 'errored' }, 'Failed', 'failed'],
    [{ status: 'interrupted' }, 'Interrupted', 'warning'],
    [{ status: 'finished', outcome: 'failed' }, 'Failed', 'failed'],
    [{ status: 'finished', outcome: 'no_part' }, 'Failed: no_part', 'failed'],
    [{ status: 'finished', outcome: 'finished', success: true }, 'Succeeded', 'done'],
    [{ status: 'finished', outcome: 'good', success: true }, 'Succeeded: good', 'done'],
  ])('%j: %s', (told, words, look) => {
    expect([runWords(run(told)), runStateOf(run(told)).look]).toEqual([words, look])
  })

  it('is none without a run', () => {
    expect(runWords(undefined)).toBe('No run')
  })

  const atGrasp = asks('root/grasp', { point: 'before', outcome: '', reasons: ['pause'] })
  it.each<[Partial<ControlView>, string, string]>([
    [{}, 'Running', ''],
    [{ paused: true }, 'Pausing', 'motions come to rest'],
    [{ paused: true, confirmed: true }, 'Paused', 'everything is at rest'],
    [{ paused: true, confirmed: true, waiting: [atGrasp] }, 'Paused', 'everything is at rest'],
    [{ paused: true, confirmed: true, waiting: [atGrasp], breakpoints: [{ path: 'root/*' }] }, 'Paused', 'breakpoint at grasp'],
    [
      { paused: true, confirmed: true, waiting: [atGrasp], breakpoints: [{ path: 'root/*', when: 'after' }] },
      'Paused',
      'everything is at rest',
    ],
    [{ paused: true, confirmed: true, cannot: ['g1'] }, 'Paused', 'cannot be held: g1'],
    [{ paused: true, stepping: true }, 'Stepping', 'to the next stop'],
    [{ waiting: [asks('root/a')] }, 'Waiting for answer', ''],
    [{ waiting: [asks('root/a'), asks('root/b')] }, 'Waiting for answer', '2 questions'],
    [{ waiting: [asks('root/a', { reasons: ['lock'] })] }, 'Waiting at lock', 'a'],
  ])('tells of the watched run %j: %s, %s', (told, word, reason) => {
    expect(runStateOf(run(), control(told))).toMatchObject({ word, reason })
  })

  it('never calls a run running that is paused', () => {
    const looks = [
      runStateOf(run({ waits: 'paused' })),
      runStateOf(run(), control({ paused: true, confirmed: true })),
      runStateOf(run(), control({ paused: true })),
    ]
    expect(looks.map(({ word, look }) => `${word} ${look}`).join()).not.toMatch(/running|active/i)
  })
})

it('is a failure where it was no success', () => {
  expect(
    [run({ status: 'errored' }), run({ status: 'finished' }), run({ status: 'finished', success: true }), run({ status: 'stopped' })].map(
      isFailed,
    ),
  ).toEqual([true, true, false, false])
})

it('says why a run failed without the name of the run', () => {
  const cause = 'run pick-20261126-132717-148b7b07 at root/open: left/gripper is in use'
  expect(runStateOf(run({ status: 'errored', cause })).reason).toBe('root/open: left/gripper is in use')
})

it('asks only for what waits for agreement', () => {
  const waiting = [asks('root/a'), asks('root/b', { reasons: ['lock'] })]
  expect(requestsOf(control({ waiting })).map((each) => each.path)).toEqual(['root/a'])
  expect(requestsOf(null)).toEqual([])
})

it('says of a node how it is, and with what it ended', () => {
  expect([nodeWords('idle'), nodeWords('active'), nodeWords('done', 'held'), nodeWords('failed', 'failed')]).toEqual([
    'Not entered',
    'Active',
    'Done: held',
    'Failed',
  ])
})

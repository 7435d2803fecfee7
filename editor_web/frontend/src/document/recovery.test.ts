/** The steps after a stop, and what is said of each. */
import { describe, expect, it } from 'vitest'
import type { ArmRecovery, CellStop, StoppedDevice } from '../api/types'
import { deviceWords, nextStep, partWords, releaseObstacle, stepsOf, undecided, type StepState } from './recovery'

const ARM: ArmRecovery = {
  name: 'left',
  part: '',
  kept: false,
  can_release: true,
  has_moved: false,
  home: 'left_home',
  home_names: ['left_home'],
  at_home: false,
  problem: '',
}
const AT_REST: StoppedDevice = { name: 'left', status: 'at_rest', after_s: 0.42, reason: '' }
const STOP: CellStop = {
  number: 1,
  phase: 'stopped',
  reason: 'smoke',
  since_unix_s: 0,
  devices: [AT_REST],
  runs: [],
  arms: [ARM],
  parts: 'absent',
  real: [],
}

function states(told: Partial<CellStop>): Readonly<Record<string, StepState>> {
  return Object.fromEntries(stepsOf({ ...STOP, ...told }).map((step) => [step.id, step.state]))
}

function withArm(told: Partial<ArmRecovery>): Partial<CellStop> {
  return { arms: [{ ...ARM, ...told }] }
}

describe('the steps after a stop', () => {
  it('lead from rest to the runs', () => {
    expect(stepsOf(STOP).map((step) => step.id)).toEqual(['rest', 'enable', 'parts', 'jog', 'home', 'reset', 'release', 'runs'])
    expect(states({})).toEqual({
      rest: 'done',
      enable: 'none',
      parts: 'none',
      jog: 'open',
      home: 'open',
      reset: 'none',
      release: 'open',
      runs: 'none',
    })
  })

  it('ask for a decision about each part that is held', () => {
    expect(states(withArm({ part: 'cube' })).parts).toBe('open')
    expect(states(withArm({ part: 'cube', kept: true })).parts).toBe('done')
    expect(undecided({ ...STOP, ...withArm({ part: 'cube' }) }).map((arm) => arm.name)).toEqual(['left'])
    expect(partWords('?')).toBe('a part whose name is not known')
  })

  it('need no jogging where every arm is at home, and are done with it where one has moved', () => {
    expect(states(withArm({ at_home: true }))).toMatchObject({ jog: 'none', home: 'done' })
    expect(states(withArm({ has_moved: true })).jog).toBe('done')
  })

  it('ask to enable real devices that may not move, after lost ones were connected again', () => {
    const device = { name: 'left', connected: true, enabled: false, problem: 'protective stop' }
    expect(states({ real: [device] }).enable).toBe('open')
    expect(nextStep(stepsOf({ ...STOP, real: [device] }))).toBe('enable')
    expect(states({ real: [{ ...device, enabled: true, problem: '' }] }).enable).toBe('done')
    const lost = stepsOf({ ...STOP, real: [{ ...device, connected: false }] }).find((step) => step.id === 'enable')
    expect(lost).toMatchObject({ state: 'problem', words: 'left: connect the cell again first' })
  })

  it('say which arm has no home', () => {
    const step = stepsOf({ ...STOP, ...withArm({ home: '' }) }).find((each) => each.id === 'home')
    expect(step).toMatchObject({ state: 'problem', words: 'left: no home is known' })
  })

  it('reset parts only in a simulation', () => {
    expect([states({ parts: 'open' }).reset, states({ parts: 'reset' }).reset]).toEqual(['open', 'done'])
  })

  it('end with the release and the runs', () => {
    const run = { id: 'r1', behavior: 'b', seq: 3, path: 'root/a' }
    expect(states({ phase: 'released', runs: [run] })).toMatchObject({ release: 'done', runs: 'open' })
    expect(nextStep(stepsOf({ ...STOP, phase: 'released', arms: [], runs: [run] }))).toBe('runs')
  })

  it('begin with a device that has not confirmed rest, which keeps the stop', () => {
    const devices: readonly StoppedDevice[] = [{ name: 'left', status: 'failed', after_s: 5, reason: 'joint 2 moves' }]
    expect(nextStep(stepsOf({ ...STOP, devices }))).toBe('rest')
    expect(releaseObstacle({ ...STOP, devices })).toContain('left has not confirmed')
    expect(releaseObstacle({ ...STOP, phase: 'stopping' })).toContain('in progress')
    expect(releaseObstacle(STOP)).toBeUndefined()
  })
})

it('says what a stop did at a device', () => {
  expect(deviceWords(AT_REST)).toBe('at rest after 0.4 s')
  expect(deviceWords({ ...AT_REST, after_s: 0.02 })).toBe('at rest after less than 0.1 s')
  expect(deviceWords({ ...AT_REST, status: 'failed', reason: 'no answer' })).toBe('has not confirmed that it is at rest: no answer')
  expect(deviceWords({ ...AT_REST, status: 'stopping' })).toBe('comes to rest')
})

import { describe, expect, it } from 'vitest'
import type { Trace } from '../api/types'
import {
  apart,
  changesOf,
  curveOf,
  endOf,
  errorsOf,
  heldWords,
  jogVelocity,
  nameFault,
  rollPitchYaw,
  tagFault,
  tagsOf,
  toolStep,
} from './teaching'

function trace(times_s: number[], joint: (t: number) => number): Trace {
  return {
    times_s,
    joint_names: ['a', 'b'],
    joints: times_s.map((t) => [joint(t), 0]),
    poses: times_s.map((t) => [joint(t), 0, 0, 0, 0, 0, 1]),
    remark: '',
  }
}

describe('names and tags', () => {
  it('are checked as the store checks them', () => {
    expect([nameFault('station_1/above.tray'), nameFault(''), nameFault('Up'), nameFault('a b')].map(Boolean)).toEqual([
      false,
      true,
      true,
      true,
    ])
    expect(tagsOf('one, two  one')).toEqual(['one', 'two'])
    expect([tagFault('one two'), tagFault('One')].map(Boolean)).toEqual([false, true])
  })
})

describe('a jog', () => {
  it('goes along one axis of the tool or with one joint', () => {
    expect(jogVelocity('tool', 2, -0.2, 7)).toEqual([0, 0, -0.05, 0, 0, 0])
    expect(jogVelocity('tool', 4, 0.5, 7)).toEqual([0, 0, 0, 0, 0.5, 0])
    expect(jogVelocity('joints', 6, 0.1, 7)).toEqual([0, 0, 0, 0, 0, 0, 0.1])
  })

  it('steps along or about an axis', () => {
    expect(toolStep(1, 0.01, 0.1)).toEqual({ step_m: [0, 0.01, 0], turn_rad: [0, 0, 0] })
    expect(toolStep(5, 0.01, -0.1)).toEqual({ step_m: [0, 0, 0], turn_rad: [0, 0, -0.1] })
  })
})

it('says roll, pitch and yaw', () => {
  const half = Math.SQRT1_2
  expect(rollPitchYaw([half, 0, 0, half])[0]).toBeCloseTo(Math.PI / 2)
  expect(rollPitchYaw([0, 0, half, half])[2]).toBeCloseTo(Math.PI / 2)
})

describe('what a change moves', () => {
  it('is told by where the arm starts and ends, and how long it takes', () => {
    const before = trace([0, 1, 2], (t) => 0.1 * t)
    expect(changesOf(before, before)).toEqual(['is the same'])
    expect(
      changesOf(
        before,
        trace([0, 3], (t) => 0.1 * t),
      ),
    ).toEqual(['ends 10.0 cm away', 'joint 1 ends 5.7° away', 'lasts 3.00 s instead of 2.00 s'])
    expect(
      changesOf(
        endOf(before),
        trace([0], () => 0.21),
      ),
    ).toEqual(['the tool moves by 10.0 mm', 'joint 1 ends 0.6° away'])
  })
})

it('measures how far two curves are apart where both are', () => {
  const one = curveOf(
    trace([0, 1, 2], (t) => 0.001 * t),
    'one',
    'tool 0',
  )
  const two = curveOf(
    trace([0.5, 1.5], (t) => 0.001 * t + 0.002),
    'two',
    'tool 0',
  )
  expect(apart(one, one)).toEqual({ rms: 0, most: 0 })
  expect(apart(two, one)?.most).toBeCloseTo(2)
  expect(
    apart(
      one,
      curveOf(
        trace([5, 6], () => 0),
        'far',
        'tool 0',
      ),
    ),
  ).toBeUndefined()
})

it('measures the errors of what was learned in the joints and at the tool, where both are', () => {
  const times = [0, 1, 2]
  const shown: Trace = {
    times_s: times,
    joint_names: ['a', 'b'],
    joints: [
      [0, 0],
      [1, 0],
      [2, 0],
    ],
    poses: times.map((x) => [x, 0, 0, 0, 0, 0, 1]),
    remark: '',
  }
  const learned: Trace = {
    ...shown,
    times_s: [1, 2],
    joints: [
      [1.1, 0],
      [2, 0],
    ],
    poses: [
      [1, 0.003, 0.004, 0, 0, 0, 1],
      [2, 0, 0, 0, 0, 0, 1],
    ],
  }
  const errors = errorsOf(shown, learned)
  expect(errors.joints?.most).toBeCloseTo(0.1)
  expect(errors.joints?.rms).toBeCloseTo(0.05)
  expect(errors.tool?.most).toBeCloseTo(0.005)
  expect(errorsOf(shown, { ...learned, joints: [] }).joints).toBeUndefined()
})

it('says what a held jog key waits for until the arm moves', () => {
  expect(heldWords('jogging', 'jog_tool')).toBe('It moves while this is held')
  expect(heldWords('idle', 'loading inverse kinematics')).toBe('Keep holding: it waits (loading inverse kinematics)')
  expect(heldWords('idle', '')).toBe('Keep holding: it waits until its path can be checked')
})

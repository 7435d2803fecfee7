import { expect, test } from 'vitest'
import { armOf, byDefault, entryNamed, traceLines } from './preview'

const PARAMETERS = { place: { type: 'string', default: 'home' }, arm: { default: 'left' }, other: { type: 'string' } }

test('an entry is named by the value, or inside it beside what else is said', () => {
  expect(entryNamed('home')).toBe('home')
  expect(entryNamed({ entry: 'swing', tau: 2 })).toBe('swing')
  for (const value of [{ xyz: [0, 0, 0] }, [1, 2], null, undefined, 3]) expect(entryNamed(value)).toBeUndefined()
})

test('an expression is what its parameter is by default, where that is all it is', () => {
  expect(byDefault('home', PARAMETERS)).toBe('home')
  expect(byDefault('${place}', PARAMETERS)).toBe('home')
  for (const text of ['${other}', '${nobody}', '${place}_2', '${ut.place}']) expect(byDefault(text, PARAMETERS)).toBeUndefined()
  expect(byDefault('${a}', { a: { default: '${place}' } })).toBeUndefined()
})

test('the arm is the one that the state moves', () => {
  expect(armOf({ robot: 'right' }, PARAMETERS)).toBe('right')
  expect(armOf({ robot: '${arm}' }, PARAMETERS)).toBe('left')
  expect(armOf({ robot: '${side}', speed: 1 }, PARAMETERS)).toBe('')
  expect(armOf({}, PARAMETERS)).toBe('')
  expect(armOf({ part: 'plate', gripper: 'left' }, PARAMETERS, ['left', 'right'])).toBe('left')
  expect(armOf({ part: 'plate', gripper: 'left' }, PARAMETERS)).toBe('')
})

test('a place is told in degrees and millimetres', () => {
  const half = Math.sqrt(0.5)
  const there = {
    times_s: [0],
    joint_names: ['a', 'b'],
    joints: [[Math.PI / 2, -1e-9]],
    poses: [[0.5, -0.1, 0, 0, 0, half, half]],
    remark: '',
  }
  expect(traceLines(there)).toEqual([
    { label: 'Joints', words: '90.0  0.0 °' },
    { label: 'Tool', words: '500.0  -100.0  0.0 mm' },
    { label: 'Roll, pitch, yaw', words: '0.0  0.0  90.0 °' },
  ])
})

test('a motion is told by its time, the way of the tool and its end', () => {
  const rows = [
    [0, 0, 0, 0, 0, 0, 1],
    [0.3, 0, 0, 0, 0, 0, 1],
    [0.3, 0.4, 0, 0, 0, 0, 1],
  ]
  const lines = traceLines({ times_s: [0, 1, 2.5], joint_names: [], joints: [], poses: rows, remark: 'out of reach' })
  expect(lines.map((line) => line.label)).toEqual(['Motion', 'Tool at the end', 'Roll, pitch, yaw'])
  expect(lines[0]?.words).toBe('2.50 s, 0.70 m of the tool')
})

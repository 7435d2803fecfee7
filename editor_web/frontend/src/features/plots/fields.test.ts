/** Choosing numbers. */
import { expect, test } from 'vitest'
import { coloured, describe, rowsOf, shownTopics } from './fields'

const joints = {
  topic: 'left/joint_state',
  type: 'JointState',
  fields: [
    { path: 'time_s', label: 'time_s', unit: 's' },
    { path: 'position_rad.0', label: 'position_rad lift', unit: 'rad' },
    { path: 'position_rad.1', label: 'position_rad turn', unit: 'rad' },
  ],
}

test('joints make a row', () => {
  expect(rowsOf(joints).map((row) => [row.name, row.unit, row.fields.length])).toEqual([
    ['time_s', 's', 1],
    ['position_rad', 'rad', 2],
  ])
})

test('a search looks at topics and fields alike', () => {
  expect(shownTopics([joints], 'left TURN')[0]?.fields.map((field) => field.path)).toEqual(['position_rad.1'])
  expect(shownTopics([joints], 'right')).toEqual([])
})

test('a number whose topic is gone keeps its path', () => {
  expect(describe('left/joint_state:position_rad.1', [joints])).toEqual({
    topic: 'left/joint_state',
    label: 'position_rad turn',
    unit: 'rad',
  })
  expect(describe('gone/x:a.b', [joints])).toEqual({ topic: 'gone/x', label: 'a.b', unit: '' })
})

test('colours stay with their curves', () => {
  const first = coloured(new Map(), ['a', 'b', 'c'])
  const second = coloured(first, ['c', 'a', 'd'])
  expect([...second].toSorted(([left], [right]) => left.localeCompare(right))).toEqual([
    ['a', 0],
    ['c', 2],
    ['d', 1],
  ])
})

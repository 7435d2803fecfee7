/** Finding by typing. */
import { expect, it } from 'vitest'
import { found } from './search'

const STATES = ['bus.WaitForMessage', 'gripper.Move', 'motion.MoveJoints', 'motion.MoveLinear', 'flow.Wait']

it.each([
  ['mj', 'motion.MoveJoints'],
  ['move lin', 'motion.MoveLinear'],
  ['wait', 'flow.Wait'],
  ['grip', 'gripper.Move'],
])('finds for %s first %s', (query, first) => {
  expect(found(STATES, query, (each) => [each])[0]).toBe(first)
})

it('keeps the order without a query, and finds nothing for nonsense', () => {
  expect(found(STATES, ' ', (each) => [each])).toEqual(STATES)
  expect(found(STATES, 'zzz', (each) => [each])).toEqual([])
})

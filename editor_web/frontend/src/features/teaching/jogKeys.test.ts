import { expect, it } from 'vitest'
import { jogKey } from './jogKeys'

it('goes along an axis of the tool, and turns about it with Shift', () => {
  expect(jogKey('tool', 'ArrowUp', false, 6)).toEqual({ axis: 0, direction: 1 })
  expect(jogKey('tool', 'PageDown', true, 6)).toEqual({ axis: 5, direction: -1 })
  expect(jogKey('tool', '1', false, 6)).toBeUndefined()
})

it('turns the joint of the digit, with Shift the other way, and no joint that is not there', () => {
  expect(jogKey('joints', '7', false, 7)).toEqual({ axis: 6, direction: 1 })
  expect(jogKey('joints', '@', true, 7)).toEqual({ axis: 1, direction: -1 })
  expect(jogKey('joints', '7', false, 6)).toBeUndefined()
})

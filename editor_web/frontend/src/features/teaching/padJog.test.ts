import { expect, it } from 'vitest'
import { heldPad, padVelocity, releasedPads, type Pad } from './padJog'

function pad(axes: readonly number[], ...down: readonly number[]): Pad {
  return { index: 3, connected: true, axes, buttons: Array.from({ length: 17 }, (_, at) => ({ pressed: down.includes(at) })) }
}

it('goes only while the deadman button of a gamepad that is there is held', () => {
  const held = pad([0, -1, 0, 0], 4)
  expect(heldPad([null, pad([0, -1, 0, 0]), held])).toBe(held)
  expect(heldPad([null, pad([0, -1, 0, 0], 0, 5)])).toBeUndefined()
  expect(heldPad([{ ...held, connected: false }])).toBeUndefined()
  expect(releasedPads([null, held, { ...pad([], 0), index: 2 }, { ...pad([]), index: 1, connected: false }])).toEqual([2])
})

it('goes along the axes of the tool, and turns about them with the other shoulder button', () => {
  expect(padVelocity(pad([0, -1, 0, 0], 4), 'tool', 0.2, 7)).toEqual([0.05, 0, 0, 0, 0, 0])
  expect(padVelocity(pad([1, 0, 0, -1], 4), 'tool', 1, 7)).toEqual([0, -0.25, 0.25, 0, 0, 0])
  expect(padVelocity(pad([0, 1, 0, 0], 4, 5), 'tool', 0.5, 7)).toEqual([0, 0, 0, -0.5, 0, 0])
})

it('turns four joints with the two sticks, and the next with the other shoulder button', () => {
  expect(padVelocity(pad([-1, 0, 0, 1], 4), 'joints', 0.5, 7)).toEqual([0.5, 0, 0, -0.5, 0, 0, 0])
  expect(padVelocity(pad([0, 0, -1, -1], 4, 5), 'joints', 1, 7)).toEqual([0, 0, 0, 0, 0, 0, 1])
})

it('stands while the sticks are about their middle', () => {
  expect(padVelocity(pad([0.14, -0.1, 0, 0.05], 4), 'tool', 1, 7).every((each) => each === 0)).toBe(true)
  expect(padVelocity(pad([], 4), 'joints', 1, 6)).toEqual([0, 0, 0, 0, 0, 0])
})

/** A course stays as it is laid out as long as its ends move together. */
import { expect, it } from 'vitest'
import { shiftOf } from './shift'

const course = [
  { x: 10, y: 20 },
  { x: 60, y: 20 },
  { x: 60, y: 80 },
  { x: 120, y: 80 },
]

it('stays where it is while its ends are at their ports', () => {
  expect(shiftOf(course, { x: 15, y: 20 }, { x: 118, y: 80 })).toEqual({ x: 0, y: 0 })
})

it('moves with a container that both ends are in, its head to where it leads', () => {
  expect(shiftOf(course, { x: 315, y: -80 }, { x: 418, y: -20 })).toEqual({ x: 298, y: -100 })
})

it('does not fit any more when one end is moved alone', () => {
  expect(shiftOf(course, { x: 15, y: 20 }, { x: 118, y: 140 })).toBeUndefined()
  expect(shiftOf(course, { x: 45, y: 20 }, { x: 118, y: 80 })).toBeUndefined()
  expect(shiftOf([], { x: 0, y: 0 }, { x: 0, y: 0 })).toBeUndefined()
})

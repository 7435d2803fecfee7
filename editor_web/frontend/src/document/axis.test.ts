/** Axes. */
import { expect, test } from 'vitest'
import { agoText, marksOf, rangeAround } from './axis'

test('marks are round and few', () => {
  expect(marksOf(0, 1, 5)).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1])
  expect(marksOf(-0.37, 0.42, 4)).toEqual([-0.2, 0, 0.2, 0.4])
  expect(marksOf(1e6, 1e6 + 3, 3)).toEqual([1000000, 1000001, 1000002, 1000003])
  expect([marksOf(1, 1, 4), marksOf(0, NaN, 4)]).toEqual([[], []])
})

test('a range has room around its values, a constant too', () => {
  expect(rangeAround(0, 1)).toEqual([-0.08, 1.08])
  expect(rangeAround(2, 2)).toEqual([1.9, 2.1])
  expect(rangeAround(Infinity, -Infinity)).toEqual([0, 1])
})

test('times before the end', () => {
  expect([0, 0.5, 30, 60, 95].map(agoText)).toEqual(['0 s', '−0.5 s', '−30 s', '−1:00', '−1:35'])
})

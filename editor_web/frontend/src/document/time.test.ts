/** Times in words. */
import { expect, it } from 'vitest'
import { duration } from './time'

it.each([
  [0.4231, '0.42 s'],
  [12.34, '12.3 s'],
  [185, '3:05 min'],
  [3723, '1:02:03 h'],
  [Number.NaN, '–'],
  [-1, '–'],
])('says %d seconds as %s', (seconds, words) => {
  expect(duration(seconds)).toBe(words)
})

/** Times in words. */
import { expect, it } from 'vitest'
import { duration, startTime } from './time'

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

it.each([
  [[1.25, 5], '1'],
  [[1.25, 1.75], '1.25'],
  [[1.251, 1.2575], '1.251'],
  [[1.2515, 1.2519], '1.251500'],
])('distinguishes runs of %s s', (starts, words) => {
  const runs = starts.map((started_at_s, index) => ({ id: `r${index}`, behavior: 'sort', started_at_s }))
  const shown = runs.map((run) => startTime(run, runs))
  expect(new Set(shown).size).toBe(2)
  expect(shown[0]?.split(':').at(-1)).toBe(`0${words}`)
})

it('shows seconds alone of runs of different behaviors', () => {
  const runs = ['sort', 'pack'].map((behavior) => ({ id: behavior, behavior, started_at_s: 1.25 }))
  expect(runs.map((run) => startTime(run, runs).split(':').at(-1))).toEqual(['01', '01'])
})

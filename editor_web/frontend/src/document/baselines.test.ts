import { expect, it } from 'vitest'
import { baselineName, differenceScale, marginOf, pointsIntervalText, ratesOf } from './baselines'

const VERSION = { version: 'abc', runs: 20, successes: 15, changed: ['behavior', 'mujoco'], saved_unix_s: 1795658400 }

it('names a baseline by when it was executed, how it did, what differs and where it is', () => {
  const kept = baselineName({ results: '.flexcell/sweeps.db', version: VERSION })
  expect(kept).toMatch(/^Nov 2\d, 2026, .* · 15 of 20 succeeded · differs in behavior, mujoco$/)
  expect(baselineName({ results: 'results/old.db', version: { ...VERSION, changed: [] } })).toMatch(/succeeded · results\/old.db$/)
})

it.each([
  ['', undefined],
  ['2', 0.02],
  ['7.3', 0.073],
  ['-1', 'The margin is 0 to 100 points'],
  ['a', 'The margin is 0 to 100 points'],
])('reads a margin of %j points', (text, margin) => {
  expect(marginOf(text)).toBe(margin)
})

it('tells both rates and their difference', () => {
  expect(ratesOf({ both: 8, only_first: 3, only_second: 1, neither: 4 })).toEqual([
    { name: 'Baseline', successes: 11, runs: 16 },
    { name: 'Now', successes: 9, runs: 16 },
  ])
  expect(pointsIntervalText([-0.123, 0.04])).toBe('−12.3 to +4.0 points')
})

it('places differences around the middle, the margin included', () => {
  const place = differenceScale([-0.1, 0.05], 0.2)
  expect(place(0)).toBe(0.5)
  expect(place(-0.2)).toBeGreaterThan(0)
  expect(place(-0.1)).toBeGreaterThan(place(-0.2))
  expect(place(0.05)).toBeCloseTo(1 - place(-0.05))
})

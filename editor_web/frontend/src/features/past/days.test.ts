/** Days of the date fields. */
import { expect, it } from 'vitest'
import { dayEndS, dayStartS } from './days'

it('begin and end at midnight where the viewer is', () => {
  const start = dayStartS('2026-03-01') ?? 0
  expect(new Date(start * 1000).getHours()).toBe(0)
  expect(new Date((dayEndS('2026-03-01') ?? 0) * 1000).getDate()).toBe(2)
})

it.each(['', 'tomorrow', '2026-13-45'])('are nothing where %j is written', (day) => {
  expect(dayStartS(day)).toBeUndefined()
  expect(dayEndS(day)).toBeUndefined()
})

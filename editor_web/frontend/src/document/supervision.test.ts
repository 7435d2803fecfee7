/** How a run is watched over. */
import { expect, it } from 'vitest'
import { SUPERVISION, supervisionOf, withAutonomy } from './supervision'

it('makes the page the operator where something may ask', () => {
  expect(withAutonomy(SUPERVISION, 'low').operates).toBe(true)
  expect(withAutonomy(SUPERVISION, 'full').operates).toBe(false)
})

it('lets a run begin only when its operator is there', () => {
  expect(supervisionOf({ ...SUPERVISION, operates: true }, false).supervision?.start_paused).toBe(true)
  expect(supervisionOf(SUPERVISION, false).supervision?.start_paused).toBe(false)
})

it('asks for breakpoints only where there are any', () => {
  expect(supervisionOf(SUPERVISION, false).breakpoints).toBe(false)
  expect(supervisionOf(SUPERVISION, true).breakpoints).toBe(true)
  expect(supervisionOf({ ...SUPERVISION, usesBreakpoints: false }, true).breakpoints).toBe(false)
})

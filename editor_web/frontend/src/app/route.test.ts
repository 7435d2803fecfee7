/** Addresses. */
import { expect, it } from 'vitest'
import {
  behaviorHref,
  sideBySideHref,
  editHref,
  PAST_HREF,
  recordingHref,
  routeOf,
  RUNS_HREF,
  SWEEPS_HREF,
  sweepHref,
  TEACH_HREF,
} from './route'

it('finds the way back from the address of a behavior, slashes and blanks included', () => {
  const id = 'behaviors/my cell/a%b.yaml'
  expect(routeOf(behaviorHref(id))).toEqual({ page: 'behavior', id })
})

it('finds the way back from the address of the editor', () => {
  const id = 'behaviors/my cell/a%b.yaml'
  expect(routeOf(editHref(id))).toEqual({ page: 'edit', id })
  expect(editHref(id, 'root/a')).toMatch(/#root\/a$/)
})

it('finds the way back from the address of a recording, and to the past runs', () => {
  const id = 'my runs/a%b.mcap'
  expect(routeOf(recordingHref(id))).toEqual({ page: 'recording', id })
  expect(routeOf(PAST_HREF)).toEqual({ page: 'past' })
  expect(routeOf(TEACH_HREF)).toEqual({ page: 'teach' })
})

it('finds the way to all runs and to two of them side by side', () => {
  expect(routeOf(RUNS_HREF)).toEqual({ page: 'runs' })
  expect(routeOf('/runs/')).toEqual({ page: 'runs' })
  expect(routeOf(sideBySideHref('a b', 'c/d'))).toEqual({ page: 'beside', left: 'a b', right: 'c/d' })
  expect(routeOf('/beside/a')).toEqual({ page: 'beside', left: 'a', right: '' })
})

it('finds the way back from the address of a sweep and of a run of it', () => {
  const id = 'my sweeps/a%b.yaml'
  expect(routeOf(sweepHref(id))).toEqual({ page: 'sweep', id })
  expect(sweepHref('a.yaml', 17)).toBe('/sweeps/a.yaml#17')
  expect(routeOf(SWEEPS_HREF)).toEqual({ page: 'sweeps' })
})

it.each(['/', '/behaviors', '/nothing/here'])('shows the home page for %s', (address) => {
  expect(routeOf(address)).toEqual({ page: 'home' })
})

/** Userdata as it is shown. */
import { expect, test } from 'vitest'
import { scopeName, shownScopes, withChanges } from './userdata'
import type { ScopeView } from '../api/types'

const scope = (values: Record<string, unknown>, isOpen = true): ScopeView => ({
  is_open: isOpen,
  since_s: 0,
  values: Object.fromEntries(Object.entries(values).map(([key, value]) => [key, { value, by: 'root/set', at_s: 1, writes: 1 }])),
})

test('changes replace whole scopes and null takes one away', () => {
  const first = withChanges({}, { '': scope({ a: 1 }), 'root#0': scope({ b: 2 }) }, true)
  expect(Object.keys(withChanges(first, { 'root#0': null, 'root#1': scope({ b: 3 }) }, false))).toEqual(['', 'root#1'])
  expect(Object.keys(withChanges(first, { root: scope({}) }, true))).toEqual(['root'])
})

test('active scopes come first, empty ones not at all', () => {
  const scopes = { root: scope({}), 'root/done': scope({ x: 1 }, false), 'root/now': scope({ y: 'pose' }) }
  expect(shownScopes(scopes, '').map((each) => each.path)).toEqual(['root/now', 'root/done'])
  expect(shownScopes(scopes, 'POSE set').map((each) => each.lines.map((line) => line.key))).toEqual([['y']])
  expect(shownScopes(scopes, 'nothing')).toEqual([])
})

test('scopes are named', () => {
  expect(['', 'root/inner', 'root/loop#2', 'root/both/left*'].map(scopeName)).toEqual([
    'Behavior',
    'root/inner',
    'root/loop, round 3',
    'root/both/left, not merged yet',
  ])
})

/** Lists of breakpoints. */
import { expect, it } from 'vitest'
import { breakpointWords, completed, matches, replaced, toggled } from './breakpoints'

it.each([
  ['root/a', 'root/a', true],
  ['root/a', 'root/ab', false],
  ['root/*', 'root/a/b', true],
  ['root/?', 'root/a', true],
  ['root/?', 'root/ab', false],
  ['root.a', 'root/a', false],
  ['*/gr(asp', 'root/gr(asp', true],
])('%s is about %s: %s', (pattern, path, expected) => {
  expect(matches(pattern, path)).toBe(expected)
})

it('is set, changed in place and taken away again', () => {
  const first = toggled([], { path: 'root/a', when: 'before' }, true)
  const both = toggled(first, { path: 'root/a', when: 'after' }, true)
  const changed = replaced(both, { ...completed({ path: 'root/a' }), if: 'tries > 1', hits: 3 })
  expect(changed.map(breakpointWords)).toEqual(['before, if tries > 1, from time 3 on', 'after'])
  expect(toggled(changed, { path: 'root/a', when: 'before' }, false).map((each) => each.when)).toEqual(['after'])
})

it('is not set twice', () => {
  const place = { path: 'root/a', when: 'before' } as const
  expect(toggled(toggled([], place, true), place, true)).toHaveLength(1)
})

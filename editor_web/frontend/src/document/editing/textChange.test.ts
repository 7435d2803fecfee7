/** Differences of texts. */
import { expect, it } from 'vitest'
import { changeBetween, folded, sideBySide } from './textChange'

it.each([
  ['abc', 'abXc'],
  ['aaa', 'aa'],
  ['', 'x'],
  ['x', ''],
  ['one two', 'two one'],
])('finds the one stretch that makes %s of %s', (after, before) => {
  const change = changeBetween(before, after)
  expect(change && before.slice(0, change.from) + change.insert + before.slice(change.to)).toBe(after)
})

it('finds no change between equal texts', () => {
  expect(changeBetween('a', 'a')).toBeUndefined()
})

it('puts lines side by side: both texts can be read off again', () => {
  const left = 'a\nb\nc\nd\ne'
  const right = 'a\nx\nc\ne\nf'
  const pairs = sideBySide(left, right)
  expect(pairs.flatMap((pair) => pair.left ?? []).join('\n')).toBe(left)
  expect(pairs.flatMap((pair) => pair.right ?? []).join('\n')).toBe(right)
  expect(pairs.filter((pair) => pair.isSame).map((pair) => pair.left)).toEqual(['a', 'c', 'e'])
})

it('folds what is the same, far from what is not', () => {
  const many = Array.from({ length: 40 }, (_, index) => `line ${index}`)
  const lines = folded(sideBySide(many.join('\n'), many.with(20, 'other').join('\n')), 2)
  expect(lines.filter((line) => line === undefined)).toHaveLength(2)
  expect(lines.filter((line) => line !== undefined)).toHaveLength(5)
})

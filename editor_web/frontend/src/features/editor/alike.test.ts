import { expect, test } from 'vitest'
import { isDrawnEqual, shareUnchanged } from './structuralSharing'

const node = (line: number, name = 'a') => ({ name, line, column: 1, end_line: line + 2, children: [], with: { x: [1] } })

test('a node that only stands elsewhere in the text is the same object as before', () => {
  const before = [{ id: 'a', data: { node: node(3), drawn: new Set(['done']) } }]
  const now = [{ id: 'a', data: { node: node(9), drawn: new Set(['done']) } }]
  expect(shareUnchanged(before, now)).toBe(before)
})

test('what says something else is taken anew, and only that', () => {
  const before = [
    { id: 'a', data: node(1) },
    { id: 'b', data: node(5) },
  ]
  const now = [
    { id: 'a', data: node(1) },
    { id: 'b', data: node(5, 'other') },
  ]
  const kept = shareUnchanged(before, now)
  expect(kept[0]).toBe(before[0])
  expect(kept[1]).toBe(now[1])
})

test('lists, sets and missing keys are told apart', () => {
  expect(isDrawnEqual({ x: undefined }, { y: undefined })).toBe(false)
  expect(isDrawnEqual([1, 2], [1, 3])).toBe(false)
  expect(isDrawnEqual(new Set(['a']), new Set(['b']))).toBe(false)
  expect(isDrawnEqual(null, {})).toBe(false)
})

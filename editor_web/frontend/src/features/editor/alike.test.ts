import { expect, test } from 'vitest'
import { isAlike, keptAlike } from './alike'

const node = (line: number, name = 'a') => ({ name, line, column: 1, end_line: line + 2, children: [], with: { x: [1] } })

test('a node that only stands elsewhere in the text is the same object as before', () => {
  const before = [{ id: 'a', data: { node: node(3), drawn: new Set(['done']) } }]
  const now = [{ id: 'a', data: { node: node(9), drawn: new Set(['done']) } }]
  expect(keptAlike(before, now)).toBe(before)
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
  const kept = keptAlike(before, now)
  expect(kept[0]).toBe(before[0])
  expect(kept[1]).toBe(now[1])
})

test('lists, sets and missing keys are told apart', () => {
  expect(isAlike({ x: undefined }, { y: undefined })).toBe(false)
  expect(isAlike([1, 2], [1, 3])).toBe(false)
  expect(isAlike(new Set(['a']), new Set(['b']))).toBe(false)
  expect(isAlike(null, {})).toBe(false)
})

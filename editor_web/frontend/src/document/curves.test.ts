/** The ring of samples. */
import { expect, test } from 'vitest'
import { csvOf, Curves } from './curves'

test('the oldest rows give way and time stays in order', () => {
  const curves = new Curves(3)
  curves.choose(['a'])
  for (const at of [1, 2, 2, 1.5, 3, 4]) curves.push(at, [at * 10])
  expect([0, 1, 2].map((row) => [curves.time(row), curves.value('a', row)])).toEqual([
    [2, 20],
    [3, 30],
    [4, 40],
  ])
  expect([curves.length, curves.rowAt(0), curves.rowAt(3), curves.rowAt(3.5), curves.rowAt(9)]).toEqual([3, 0, 1, 2, 3])
  expect([1.2, 2.4, 2.6, 99].map((at) => curves.nearest(at))).toEqual([0, 0, 1, 2])
  expect(new Curves(3).nearest(1)).toBeUndefined()
})

test('another choice keeps what was sampled of those that stay', () => {
  const curves = new Curves(4)
  curves.choose(['a', 'b'])
  curves.push(1, [1, null])
  curves.choose(['b', 'c', 'a'])
  curves.push(2, [20, 30, 10])
  expect(['a', 'b', 'c'].map((name) => [curves.value(name, 0), curves.value(name, 1)])).toEqual([
    [1, 10],
    [NaN, 20],
    [NaN, 30],
  ])
})

test('a copy stays while the ring goes on', () => {
  const curves = new Curves(2)
  curves.choose(['a'])
  curves.push(1, [1])
  const copy = curves.copy()
  curves.push(2, [2])
  curves.push(3, [3])
  expect([copy.length, copy.time(0), copy.value('a', 0)]).toEqual([1, 1, 1])
})

test('CSV has a column for each curve and empty cells for gaps', () => {
  const curves = new Curves(4)
  curves.choose(['a', 'b'])
  curves.push(1.5, [0.1, null])
  expect(csvOf(curves, { a: 'left "x" (m)' })).toBe('time_s,"left ""x"" (m)","b"\r\n1.500,0.1,\r\n')
})

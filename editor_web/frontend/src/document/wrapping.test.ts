/** A long drawing in rows: nothing is lost, nothing overlaps, arrows go around the ends of rows. */
import { expect, it } from 'vitest'
import type { Point } from './geometry'
import { wrapped } from './wrapping'

const WIDE = { y: 0, width: 100, height: 50 }
const boxes = new Map(['a', 'b', 'c', 'd', 'e', 'f'].map((id, index) => [id, { ...WIDE, x: 150 * index }]))
const between = (from: number, to: number) => [
  { x: 150 * from + 100, y: 25 },
  { x: 150 * to, y: 25 },
]
const chain = [0, 1, 2, 3, 4].map((from) => ({ id: `${from}`, points: between(from, from + 1) }))
/** From the end of `f` below everything back to `a`. */
const back = {
  id: 'back',
  points: [
    { x: 850, y: 40 },
    { x: 860, y: 40 },
    { x: 860, y: 80 },
    { x: -10, y: 80 },
    { x: -10, y: 40 },
    { x: 0, y: 40 },
  ],
}

const straight = (points: readonly Point[]) =>
  points.slice(1).every((point, index) => point.x === points[index]?.x || point.y === points[index]?.y)

it('leaves what is short enough as it is, with room around', () => {
  const { boxes: placed, lines, width } = wrapped({ boxes, lines: chain }, 850)
  expect([...placed.values()].map(({ x, y }) => [x, y])).toEqual([0, 1, 2, 3, 4, 5].map((index) => [16 + 150 * index, 0]))
  expect(lines.every((line) => line.points.length === 2)).toBe(true)
  expect(width).toBe(850 + 32)
})

it('begins each row at the left, below the one before', () => {
  const { boxes: placed } = wrapped({ boxes, lines: chain }, 400)
  const at = (id: string) => placed.get(id) ?? { x: NaN, y: NaN }
  expect(at('d').x).toBe(at('a').x)
  expect(at('d').y).toBeGreaterThan(at('a').y + 50)
  expect([at('e').x - at('d').x, at('f').x - at('e').x]).toEqual([150, 150])
})

it('takes every arrow from its source to its target without a slanted line, backwards too', () => {
  const { boxes: placed, lines, width, height } = wrapped({ boxes, lines: [...chain, back] }, 250)
  const end = (id: string) => lines.find((line) => line.id === id)?.points ?? []
  const at = (id: string) => placed.get(id) ?? { x: NaN, y: NaN }
  expect(end('1')[0]).toEqual({ x: at('b').x + 100, y: at('b').y + 25 })
  expect(end('1').at(-1)).toEqual({ x: at('c').x, y: at('c').y + 25 })
  expect(end('back')[0]).toEqual({ x: at('f').x + 100, y: at('f').y + 40 })
  expect(end('back').at(-1)).toEqual({ x: at('a').x, y: at('a').y + 40 })
  for (const { points } of lines) {
    expect(straight(points)).toBe(true)
    for (const { x, y } of points) {
      expect(x >= 0 && x <= width && y >= 0 && y <= height).toBe(true)
    }
  }
})

it('moves nothing in the rows before one that is added', () => {
  const more = new Map([...boxes, ['g', { ...WIDE, x: 900 }]])
  const before = wrapped({ boxes, lines: chain }, 400)
  const after = wrapped({ boxes: more, lines: [...chain, { id: '5', points: between(5, 6) }] }, 400)
  expect([...after.boxes].slice(0, 6)).toEqual([...before.boxes])
})

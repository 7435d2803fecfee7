import { expect, it } from 'vitest'
import type { Box } from '../geometry'
import { aligned, type Alignment } from './neighbors'

const WAYS: readonly Alignment[] = ['left', 'center', 'right', 'top', 'middle', 'bottom', 'row', 'column', 'across', 'down']
const BOXES = new Map<string, Box>([
  ['a', { x: 0, y: 0, width: 100, height: 40 }],
  ['b', { x: 300, y: 10, width: 60, height: 90 }],
  ['c', { x: 130, y: 20, width: 80, height: 60 }],
])

function moved(how: Alignment, boxes = BOXES): Box[] {
  const corners = aligned(boxes, how)
  return [...boxes].map(([id, box]) => ({ ...box, ...corners.get(id) }))
}

function areApart(a: Box, b: Box): boolean {
  return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y
}

it.each(WAYS)('lays no node on another: %s', (how) => {
  const boxes = moved(how)
  for (const [index, box] of boxes.entries()) {
    for (const other of boxes.slice(index + 1)) expect(areApart(box, other)).toBe(true)
  }
})

it('puts edges in line', () => {
  expect(new Set(moved('left').map((box) => box.x))).toEqual(new Set([0]))
  expect(new Set(moved('bottom').map((box) => box.y + box.height))).toEqual(new Set([100]))
})

it('leaves where they are those that are in line already', () => {
  const apart = new Map([...BOXES].map(([id, box], index) => [id, { ...box, y: index * 200 }] as const))
  expect(moved('left', apart).map((box) => box.y)).toEqual([0, 200, 400])
})

it('distributes with equal spaces between the first and the last', () => {
  const [a, b, c] = moved('across')
  expect([a?.x, c?.x, b?.x]).toEqual([0, 160, 300])
  const tall = new Map([...BOXES].map(([id, box]) => [id, id === 'b' ? { ...box, y: 400 } : box] as const))
  expect(moved('down', tall).map((box) => box.y)).toEqual([0, 400, 190])
})

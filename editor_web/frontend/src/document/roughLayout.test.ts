import { expect, test } from 'vitest'
import type { ElkShape } from './layout'
import { layOutRoughly } from './roughLayout'

const graph = (count: number, layoutOptions: Record<string, string>): ElkShape => ({
  id: 'root',
  children: Array.from({ length: count }, (_, index) => ({ id: `n${index}`, width: 100, height: 40 })),
  layoutOptions,
})

test('nodes stand in one row where the engine would not wrap them, downwards in one column', async () => {
  const row = await layOutRoughly(graph(4, { 'elk.direction': 'RIGHT' }))
  expect([row.width, row.height]).toEqual([4 * 100 + 3 * 56, 40])
  const column = await layOutRoughly(graph(4, { 'elk.direction': 'DOWN' }))
  expect([column.width, column.height]).toEqual([100, 4 * 40 + 3 * 56])
})

test('with a ratio they are wrapped, and every node keeps its size and gets a place of its own', async () => {
  const laidOut = await layOutRoughly(graph(20, { 'elk.aspectRatio': '2' }))
  expect((laidOut.width ?? 0) / (laidOut.height ?? 1)).toBeGreaterThan(1)
  expect((laidOut.width ?? 0) / (laidOut.height ?? 1)).toBeLessThan(4)
  const places = (laidOut.children ?? []).map(({ x, y, width, height }) => `${x} ${y} ${width} ${height}`)
  expect(new Set(places).size).toBe(20)
  expect(places.every((place) => place.endsWith(' 100 40'))).toBe(true)
})

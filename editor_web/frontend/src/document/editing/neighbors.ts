/** Moving on the canvas with the arrow keys, and putting boxes in line. Pure. */
import type { Box, Point } from '../geometry'

export type Heading = 'ArrowLeft' | 'ArrowRight' | 'ArrowUp' | 'ArrowDown'

const DIRECTIONS: Record<Heading, Point> = {
  ArrowLeft: { x: -1, y: 0 },
  ArrowRight: { x: 1, y: 0 },
  ArrowUp: { x: 0, y: -1 },
  ArrowDown: { x: 0, y: 1 },
}

/** The box that lies next in a direction from `from`, by absolute boxes; undefined where there is none. */
export function neighborOf(boxes: ReadonlyMap<string, Box>, from: string, heading: Heading): string | undefined {
  const start = boxes.get(from)
  if (!start) return undefined
  const direction = DIRECTIONS[heading]
  const origin = centerOf(start)
  let best: { id: string; cost: number } | undefined
  for (const [id, box] of boxes) {
    if (id === from || contains(box, start)) continue
    const center = centerOf(box)
    const along = (center.x - origin.x) * direction.x + (center.y - origin.y) * direction.y
    const across = Math.abs((center.x - origin.x) * direction.y) + Math.abs((center.y - origin.y) * direction.x)
    if (along < 4 || across > along * 3 + 60) continue
    const cost = along + across * 2
    if (!best || cost < best.cost) best = { id, cost }
  }
  return best?.id
}

function centerOf(box: Box): Point {
  return { x: box.x + box.width / 2, y: box.y + Math.min(box.height / 2, 24) }
}

function contains(outer: Box, inner: Box): boolean {
  return (
    outer.x <= inner.x &&
    outer.y <= inner.y &&
    outer.x + outer.width >= inner.x + inner.width &&
    outer.y + outer.height >= inner.y + inner.height
  )
}

export type Alignment = 'left' | 'center' | 'right' | 'top' | 'middle' | 'bottom' | 'row' | 'column' | 'across' | 'down'

/** Least space between boxes beside and above one another. */
const SPACE = { x: 44, y: 22 } as const

type Axis = 'x' | 'y'
type Placed = readonly [string, Box]

/** New corners that put boxes in line, one after the other, or with equal spaces; none lies on another. */
export function aligned(boxes: ReadonlyMap<string, Box>, how: Alignment): ReadonlyMap<string, Point> {
  const all = [...boxes]
  const left = Math.min(...all.map(([, b]) => b.x))
  const top = Math.min(...all.map(([, b]) => b.y))
  const right = Math.max(...all.map(([, b]) => b.x + b.width))
  const bottom = Math.max(...all.map(([, b]) => b.y + b.height))
  switch (how) {
    case 'left':
      return apart(all, 'y', (b) => ({ ...b, x: left }))
    case 'center':
      return apart(all, 'y', (b) => ({ ...b, x: (left + right - b.width) / 2 }))
    case 'right':
      return apart(all, 'y', (b) => ({ ...b, x: right - b.width }))
    case 'top':
      return apart(all, 'x', (b) => ({ ...b, y: top }))
    case 'middle':
      return apart(all, 'x', (b) => ({ ...b, y: (top + bottom - b.height) / 2 }))
    case 'bottom':
      return apart(all, 'x', (b) => ({ ...b, y: bottom - b.height }))
    case 'row':
      return spaced(all, 'x', SPACE.x, (b) => ({ ...b, y: top }))
    case 'column':
      return spaced(all, 'y', SPACE.y, (b) => ({ ...b, x: left }))
    case 'across':
      return spaced(all, 'x', equalSpace(all, 'x', left, right), (b) => b)
    case 'down':
      return spaced(all, 'y', equalSpace(all, 'y', top, bottom), (b) => b)
  }
}

function sizeOf(box: Box, axis: Axis): number {
  return axis === 'x' ? box.width : box.height
}

function movedTo(axis: Axis, at: number, { x, y }: Point): Point {
  return axis === 'x' ? { x: at, y } : { x, y: at }
}

function inOrder(all: readonly Placed[], axis: Axis): readonly Placed[] {
  return all.toSorted(([, a], [, b]) => a[axis] - b[axis])
}

/** Boxes in line; those that would lie on the one before are moved on along the line. */
function apart(all: readonly Placed[], axis: Axis, put: (box: Box) => Box): ReadonlyMap<string, Point> {
  let free = -Infinity
  return new Map(
    inOrder(all, axis).map(([id, box]) => {
      const at = Math.max(box[axis], free)
      free = at + sizeOf(box, axis) + SPACE[axis]
      const { x, y } = put(box)
      return [id, movedTo(axis, at, { x, y })] as const
    }),
  )
}

/** One box after the other, with the same space between them. */
function spaced(all: readonly Placed[], axis: Axis, space: number, put: (box: Box) => Box): ReadonlyMap<string, Point> {
  let at = Math.min(...all.map(([, box]) => box[axis]))
  return new Map(
    inOrder(all, axis).map(([id, box]) => {
      const { x, y } = put(box)
      const corner = movedTo(axis, at, { x, y })
      at += sizeOf(box, axis) + space
      return [id, corner] as const
    }),
  )
}

/** The space between boxes that leaves the first and the last where they are, as far as there is room. */
function equalSpace(all: readonly Placed[], axis: Axis, start: number, end: number): number {
  const filled = all.reduce((sum, [, box]) => sum + sizeOf(box, axis), 0)
  return Math.max(SPACE[axis], (end - start - filled) / Math.max(1, all.length - 1))
}

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

export type Alignment = 'left' | 'center' | 'right' | 'top' | 'middle' | 'bottom' | 'row' | 'column'

const SPACE = 44

/** New corners that put boxes in line, or one after the other with equal spaces. */
export function aligned(boxes: ReadonlyMap<string, Box>, how: Alignment): ReadonlyMap<string, Point> {
  const all = [...boxes]
  const left = Math.min(...all.map(([, b]) => b.x))
  const top = Math.min(...all.map(([, b]) => b.y))
  const right = Math.max(...all.map(([, b]) => b.x + b.width))
  const bottom = Math.max(...all.map(([, b]) => b.y + b.height))
  switch (how) {
    case 'left':
      return put(all, (b) => ({ x: left, y: b.y }))
    case 'center':
      return put(all, (b) => ({ x: (left + right - b.width) / 2, y: b.y }))
    case 'right':
      return put(all, (b) => ({ x: right - b.width, y: b.y }))
    case 'top':
      return put(all, (b) => ({ x: b.x, y: top }))
    case 'middle':
      return put(all, (b) => ({ x: b.x, y: (top + bottom - b.height) / 2 }))
    case 'bottom':
      return put(all, (b) => ({ x: b.x, y: bottom - b.height }))
    case 'row':
      return inLine(
        all,
        (b) => b.x,
        (b, at) => ({ x: at, y: top, next: at + b.width + SPACE }),
        left,
      )
    case 'column':
      return inLine(
        all,
        (b) => b.y,
        (b, at) => ({ x: left, y: at, next: at + b.height + SPACE / 2 }),
        top,
      )
  }
}

function put(all: readonly [string, Box][], place: (box: Box) => Point): ReadonlyMap<string, Point> {
  return new Map(all.map(([id, box]) => [id, place(box)]))
}

function inLine(
  all: readonly [string, Box][],
  order: (box: Box) => number,
  place: (box: Box, at: number) => Point & { next: number },
  start: number,
): ReadonlyMap<string, Point> {
  const out = new Map<string, Point>()
  let at = start
  for (const [id, box] of all.toSorted(([, a], [, b]) => order(a) - order(b))) {
    const { x, y, next } = place(box, at)
    out.set(id, { x, y })
    at = next
  }
  return out
}

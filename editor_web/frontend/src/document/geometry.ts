/** Points, boxes, and paths through points. Pure. */

export interface Point {
  readonly x: number
  readonly y: number
}

export interface Size {
  readonly width: number
  readonly height: number
}

export interface Box extends Point, Size {}

export function moved(point: Point, by: Point): Point {
  return { x: point.x + by.x, y: point.y + by.y }
}

/** A path through the points with rounded corners, for an SVG `d`. */
export function roundedPath(points: readonly Point[], radius = 8): string {
  const [first, ...rest] = points
  if (!first) return ''
  const parts = [`M ${first.x} ${first.y}`]
  rest.forEach((corner, index) => {
    const before = points[index] ?? corner
    const after = points[index + 2]
    if (!after) {
      parts.push(`L ${corner.x} ${corner.y}`)
      return
    }
    const r = Math.min(radius, distance(before, corner) / 2, distance(corner, after) / 2)
    const from = towards(corner, before, r)
    const to = towards(corner, after, r)
    parts.push(`L ${from.x} ${from.y} Q ${corner.x} ${corner.y} ${to.x} ${to.y}`)
  })
  return parts.join(' ')
}

function distance(a: Point, b: Point): number {
  return Math.hypot(a.x - b.x, a.y - b.y)
}

function towards(from: Point, to: Point, length: number): Point {
  const whole = distance(from, to) || 1
  return { x: from.x + ((to.x - from.x) * length) / whole, y: from.y + ((to.y - from.y) * length) / whole }
}

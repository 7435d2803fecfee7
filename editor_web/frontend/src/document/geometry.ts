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

/** The place nearest to where a box is, straight to one side, where it is so far apart from all that is taken. */
export function freePlace({ x, y, width, height }: Box, taken: readonly Box[], apart: number): Point {
  const at: Point = { x, y }
  const covered = (place: Point) =>
    taken.find(
      (box) =>
        box.x < place.x + width + apart &&
        box.x + box.width + apart > place.x &&
        box.y < place.y + height + apart &&
        box.y + box.height + apart > place.y,
    )
  const past = (step: (box: Box, place: Point) => Point) => {
    let place = at
    for (let box = covered(place); box; box = covered(place)) place = step(box, place)
    return place
  }
  const places = [
    past((box, from) => ({ x: from.x, y: box.y + box.height + apart })),
    past((box, from) => ({ x: from.x, y: box.y - height - apart })),
    past((box, from) => ({ x: box.x + box.width + apart, y: from.y })),
    past((box, from) => ({ x: box.x - width - apart, y: from.y })),
  ]
  return places.reduce((best, place) => (distance(place, at) < distance(best, at) ? place : best))
}

/** The box around all of these; they are at least one. */
export function boundsOf(boxes: readonly Box[]): Box {
  const x = boxes.reduce((least, box) => Math.min(least, box.x), Infinity)
  const y = boxes.reduce((least, box) => Math.min(least, box.y), Infinity)
  const right = boxes.reduce((most, box) => Math.max(most, box.x + box.width), -Infinity)
  const bottom = boxes.reduce((most, box) => Math.max(most, box.y + box.height), -Infinity)
  return { x, y, width: right - x, height: bottom - y }
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

/** Whether a laid-out course still leads from end to end, or how far it has moved as a whole. Pure. */
import type { Point } from '../geometry'

/** Ports are wider than they are high. */
const TOLERANCE = { x: 12, y: 3 }

/** How far the course is to be moved to lead `from` one end `to` the other; undefined where they moved apart. */
export function shiftOf(course: readonly Point[], from: Point, to: Point): Point | undefined {
  const [first, last] = [course[0], course.at(-1)]
  if (!first || !last) return undefined
  const [begin, end] = [between(first, from), between(last, to)]
  if (isNear(begin) && isNear(end)) return { x: 0, y: 0 }
  return isNear(between(begin, end)) ? end : undefined
}

function between(from: Point, to: Point): Point {
  return { x: to.x - from.x, y: to.y - from.y }
}

function isNear({ x, y }: Point): boolean {
  return Math.abs(x) < TOLERANCE.x && Math.abs(y) < TOLERANCE.y
}

/** Some nodes of a machine are laid out among themselves, around where they are; the others stay. Pure, apart from the layout engine. */
import { boundsOf, freePlace, type Box, type Point } from '../geometry'
import { arrangeAmong } from './arrange'
import type { EngineOptions } from './engineLayout'
import type { EditNode } from './model'

/** Left free between what is laid out and what stays. */
const APART_PX = 26

/** Each with where it goes, by path; nothing where they are laid out already. */
export type Corners = ReadonlyMap<string, Point>

/**
 * Where the `chosen` children of a machine go: in rows as the whole machine would be laid out, or in rows no longer than
 * the room that they take now, whichever stays nearer to it. `boxes` are those of all children; `others` is what stands
 * on the same canvas besides, and what is laid out covers it no more than the other children.
 */
export async function layOutChosen(
  machine: EditNode,
  chosen: ReadonlySet<string>,
  { boxes, others }: { readonly boxes: ReadonlyMap<string, Box>; readonly others: readonly Box[] },
  { rowLimit, call }: EngineOptions,
): Promise<Corners> {
  const ours = new Map([...boxes].filter(([path]) => chosen.has(path)))
  if (ours.size === 0) return new Map()
  const taken = [...[...boxes].filter(([path]) => !chosen.has(path)).map(([, box]) => box), ...others]
  const now = boundsOf([...ours.values()])
  const limits = [rowLimit, ...(now.width < rowLimit ? [now.width] : [])]
  const drafts = await Promise.all(limits.map((limit) => arrangeAmong(machine, ours, { rowLimit: limit, call })))
  const placed = drafts.map((draft) => placedNear(now, draft, taken))
  const best = placed.reduce((one, other) => (other.distance < one.distance ? other : one))
  const isStill = [...best.corners].every(([path, at]) => isNear(at, ours.get(path) ?? at))
  return isStill ? new Map() : best.corners
}

/** What was laid out with its middle where the middle was, or at the free place nearest to that. */
function placedNear(
  now: Box,
  draft: ReadonlyMap<string, Box>,
  taken: readonly Box[],
): { readonly corners: Corners; readonly distance: number } {
  const made = boundsOf([...draft.values()])
  const wish = {
    x: Math.round(now.x + (now.width - made.width) / 2),
    y: Math.round(now.y + (now.height - made.height) / 2),
  }
  const place = freePlace({ ...made, ...wish }, taken, APART_PX)
  const corners = new Map([...draft].map(([path, box]) => [path, { x: box.x - made.x + place.x, y: box.y - made.y + place.y }]))
  return { corners, distance: Math.hypot(place.x - wish.x, place.y - wish.y) }
}

/** Positions are written in whole pixels: less than two is no other place. */
function isNear(one: Point, other: Point): boolean {
  return Math.abs(one.x - other.x) < 2 && Math.abs(one.y - other.y) < 2
}

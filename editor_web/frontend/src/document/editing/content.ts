/** What has been laid out so far: boxes of one frame, and of the frames inside it. Pure. */
import { moved, type Box, type Point, type Size } from '../geometry'

/** It is filled while it is laid out. */
export interface Content {
  width: number
  height: number
  /** In the frame that is being filled. */
  own: Map<string, Box>
  /** In frames inside it, relative to those. */
  deep: Map<string, Box>
  routes: Map<string, readonly Point[]>
  origins: Map<string, Point>
}

export function empty(width = 0, height = 0): Content {
  return { width, height, own: new Map(), deep: new Map(), routes: new Map(), origins: new Map() }
}

/** Put a node at a place of `outer`; what is in it is relative to it and stays. */
export function put(outer: Content, id: string, box: Box, inner: Content): void {
  outer.own.set(id, box)
  for (const [path, each] of [...inner.deep, ...inner.own]) outer.deep.set(path, each)
  carry(outer, inner, box)
}

/** Take over what is in `inner`, which stands in the same frame, moved by `shift`. */
export function adopt(outer: Content, inner: Content, shift: Point): void {
  for (const [id, box] of inner.own) outer.own.set(id, { ...box, ...moved(box, shift) })
  for (const [id, box] of inner.deep) outer.deep.set(id, box)
  carry(outer, inner, shift)
}

function carry(outer: Content, inner: Content, shift: Point): void {
  for (const [id, points] of inner.routes)
    outer.routes.set(
      id,
      points.map((point) => moved(point, shift)),
    )
  for (const [path, origin] of inner.origins) outer.origins.set(path, origin)
}

export function sized(size: Size): Content {
  return empty(size.width, size.height)
}

/** Where things are on the canvas as it is drawn: boxes, containers under a point, positions inside a container. */
import type { InternalNode } from '@xyflow/react'
import { frameOf } from '../../document/editing/expansion'
import { isForeign, isHolder, nodeOf } from '../../document/editing/model'
import type { Box, Point } from '../../document/geometry'
import type { CanvasNode } from './elements'
import { rootOf, editor } from './store'
import type { Arranged } from './useArrangement'

/** What the canvas draws, and where React Flow has put it. */
export interface DrawnCanvas {
  readonly arranged: Arranged
  readonly computed: readonly CanvasNode[]
  readonly getInternalNode: (id: string) => InternalNode<CanvasNode> | undefined
}

/** The box of a node on the whole canvas; undefined where it is not drawn. */
export function boxOf({ getInternalNode }: DrawnCanvas, id: string): Box | undefined {
  const node = getInternalNode(id)
  if (!node) return undefined
  return { ...node.internals.positionAbsolute, width: node.width ?? 0, height: node.height ?? 0 }
}

/** The innermost open container at a place; the one that fills the canvas where there is none. */
export function frameAt(canvas: DrawnCanvas, at: Point, isLeftOut: (path: string) => boolean = () => false): string {
  const hits = canvas.computed
    .filter((node) => node.type === 'frame' && !isLeftOut(node.id))
    .filter((node) => {
      const box = boxOf(canvas, node.id)
      return box && at.x >= box.x && at.x <= box.x + box.width && at.y >= box.y && at.y <= box.y + box.height
    })
    .map((node) => node.id)
  return hits.toSorted((a, b) => b.length - a.length)[0] ?? canvas.arranged.scope.path
}

/** A place of the canvas as a position in a container. */
export function positionIn(canvas: DrawnCanvas, path: string, at: Point): Point {
  const { arrangement, scope } = canvas.arranged
  const box = path === scope.path ? undefined : boxOf(canvas, path)
  const origin = arrangement.origins.get(path)
  return { x: at.x - (box?.x ?? 0) - (origin?.x ?? 0), y: at.y - (box?.y ?? 0) - (origin?.y ?? 0) }
}

/** The container under the middle of what was dragged, where it is another one than before. */
export function holderUnder(canvas: DrawnCanvas, moved: readonly CanvasNode[]): string | undefined {
  const first = moved[0]
  const box = first && boxOf(canvas, first.id)
  if (!first || !box) return undefined
  const middle = { x: box.x + box.width / 2, y: box.y + 20 }
  const at = frameAt(canvas, middle, (path) => moved.some((node) => path === node.id || path.startsWith(`${node.id}/`)))
  const root = rootOf(editor())
  const now = root && frameOf(canvas.arranged.scope, first.id).path
  if (!root || at === now || isForeign(root, `${at}/x`)) return undefined
  const holder = nodeOf(root, at)
  return holder && isHolder(holder) ? at : undefined
}

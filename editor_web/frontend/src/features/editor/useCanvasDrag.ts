/** Dragging nodes on the canvas: to another place of their container, or into another container. */
import { useCallbackRef } from '@mantine/hooks'
import { isMachine, nodeOf } from '../../document/editing/model'
import { parentPath } from '../../document/path'
import { moveInto } from './actions'
import { boxOf, holderUnder, positionIn, type DrawnCanvas } from './canvasPlaces'
import type { CanvasNode } from './elements'
import { place } from './placing'
import { editor, rootOf } from './store'
import type { FrameDrag } from './useFrameDrag'

/** A shorter way is a click that shook. */
const LEAST_PX = 2

export interface CanvasDrag {
  readonly onNodeDragStart: (event: unknown, node: CanvasNode, dragged: CanvasNode[]) => void
  readonly onSelectionDragStart: (event: unknown, dragged: CanvasNode[]) => void
  readonly onNodeDragStop: (event: unknown, node: CanvasNode, dragged: CanvasNode[]) => void
  readonly onSelectionDragStop: (event: unknown, dragged: CanvasNode[]) => void
}

/** What is given to React Flow stays the same function: all it draws is looked through for each new one. */
export function useCanvasDrag(canvas: DrawnCanvas, putBack: () => void, { begin, end }: FrameDrag): CanvasDrag {
  const stop = (dragged: readonly CanvasNode[]): void => {
    end()
    const root = rootOf(editor())
    const moved = dragged.filter((node) => node.type !== 'pill' && node.type !== 'rules')
    if (!root || moved.length === 0) return
    const target = holderUnder(canvas, moved)
    if (target) {
      const places = moved.flatMap((node) => {
        const box = boxOf(canvas, node.id)
        return box ? [[node.id, positionIn(canvas, target, box)] as const] : []
      })
      void moveInto(
        moved.map((node) => node.id),
        target,
        new Map(places),
      )
      putBack()
      return
    }
    const changed = moved.filter((node) => hasMoved(canvas, node))
    // What a tree or a concurrency lays out has no place of its own.
    const free = changed.filter((node) => isMachine(nodeOf(root, parentPath(node.id))?.kind ?? ''))
    if (free.length > 0)
      void place(new Map(free.map((node) => [node.id, node.position]))).then((isThere) => {
        if (!isThere) putBack()
      })
    if (free.length < changed.length) putBack()
  }
  return {
    onNodeDragStart: useCallbackRef((_event: unknown, _node: CanvasNode, dragged: CanvasNode[]) => begin(dragged)),
    onSelectionDragStart: useCallbackRef((_event: unknown, dragged: CanvasNode[]) => begin(dragged)),
    onNodeDragStop: useCallbackRef((_event: unknown, _node: CanvasNode, dragged: CanvasNode[]) => stop(dragged)),
    onSelectionDragStop: useCallbackRef((_event: unknown, dragged: CanvasNode[]) => stop(dragged)),
  }
}

function hasMoved({ arranged }: DrawnCanvas, { id, position }: CanvasNode): boolean {
  const before = arranged.arrangement.boxes.get(id)
  return before !== undefined && (Math.abs(before.x - position.x) > LEAST_PX || Math.abs(before.y - position.y) > LEAST_PX)
}

/** Where nodes are on the canvas: put, kept, in line, or laid out by itself again. */
import { corner } from '../../document/editing/edits'
import type { Corner } from '../../document/editing/edits'
import { isMachine, isTreePart, nodeOf, type EditNode } from '../../document/editing/model'
import { aligned, type Alignment } from '../../document/editing/neighbors'
import type { Box } from '../../document/geometry'
import { nameOfPath, parentPath } from '../../document/path'
import { perform } from './apply'
import { canvasBoxes } from './canvasPositions'
import { outermost } from './selected'
import { rootOf, editor, scopeOf, showEditorNotice, showEditorRefusal } from './store'

/** Forget where nodes were put: the container that fills the canvas is laid out by itself again. */
export async function layOutAnew(): Promise<void> {
  const scope = scopeOf(editor())
  const placed = scope ? positionedBelow(scope) : []
  if (placed.length === 0) {
    showEditorNotice('It is laid out already')
    return
  }
  await perform('Auto-layout', [{ edit: 'set_positions', positions: Object.fromEntries(placed.map((path) => [path, null])) }])
}

function positionedBelow(node: EditNode): readonly string[] {
  return node.children.flatMap((child) => [...(child.position ? [child.path] : []), ...positionedBelow(child)])
}

/** The children of a machine where they are seen now; none where they have positions already, or it is laid out otherwise. */
export function seenPositions(parent: EditNode): Record<string, Corner> {
  if (!isMachine(parent.kind) || parent.children.some((child) => child.position !== null)) return {}
  const { boxes, origins } = canvasBoxes()
  const origin = origins.get(parent.path) ?? { x: 0, y: 0 }
  return Object.fromEntries(
    parent.children.flatMap((child): [string, Corner][] => {
      const box = boxes.get(child.path)
      return box ? [[child.path, corner(box.x - origin.x, box.y - origin.y)]] : []
    }),
  )
}

/**
 * Put nodes where they were dragged to; false where they are not there.
 * The first one that is moved pins its siblings, which stay where they are seen.
 */
export async function place(moved: ReadonlyMap<string, { x: number; y: number }>): Promise<boolean> {
  const root = rootOf(editor())
  const { origins } = canvasBoxes()
  const positions: Record<string, Corner> = {}
  for (const [path, at] of moved) {
    const parent = nodeOf(root, parentPath(path))
    if (!parent || isTreePart(parent.kind) || !isMachine(parent.kind)) continue
    const origin = origins.get(parent.path) ?? { x: 0, y: 0 }
    for (const [sibling, seen] of Object.entries(seenPositions(parent))) positions[sibling] ??= seen
    positions[path] = corner(at.x - origin.x, at.y - origin.y)
  }
  if (Object.keys(positions).length === 0) return false
  const words = moved.size === 1 ? `Move ${nameOfPath([...moved.keys()][0] ?? '')}` : `Move ${moved.size} nodes`
  return (await perform(words, [{ edit: 'set_positions', positions }])) !== undefined
}

export async function align(how: Alignment): Promise<void> {
  const { boxes } = canvasBoxes()
  const chosen = new Map(outermost().flatMap((path): [string, Box][] => (boxes.has(path) ? [[path, boxes.get(path) as Box]] : [])))
  if (chosen.size < 2) {
    showEditorRefusal('Align', 'select two nodes or more')
    return
  }
  await place(aligned(chosen, how))
}

/** Where nodes are on the canvas itself, those in frames too. */
import type { Box } from '../../document/geometry'
import type { CanvasNode } from './elements'

/** By id, outcomes and rules included; frames come before what is in them. What hangs on an anchor is where its frame is. */
export function nodeBoxes(nodes: readonly CanvasNode[]): ReadonlyMap<string, Box> {
  const boxes = new Map<string, Box>()
  for (const node of nodes) {
    const carrier = node.type === 'anchor' ? boxes.get(node.data.frame) : undefined
    if (carrier) {
      boxes.set(node.id, carrier)
      continue
    }
    const outer = node.parentId === undefined ? undefined : boxes.get(node.parentId)
    boxes.set(node.id, {
      x: (outer?.x ?? 0) + node.position.x,
      y: (outer?.y ?? 0) + node.position.y,
      width: node.width ?? 0,
      height: node.height ?? 0,
    })
  }
  return boxes
}

/** What is drawn in an open container that is dragged: it hangs on an anchor that stays, and its drawing is shifted as one. */
import type { Point } from '../../document/geometry'
import type { AnchorNode, CanvasNode } from './elements'

/** Where a container was when its drag began, for what is in it. */
export interface DraggedFrame {
  readonly path: string
  readonly anchor: AnchorNode
}

export function anchorId(path: string): string {
  return `${path}~anchor`
}

export function draggedFrames(dragged: readonly CanvasNode[]): readonly DraggedFrame[] {
  return dragged
    .filter((node) => node.type === 'frame')
    .map(({ id, position, parentId }) => ({
      path: id,
      anchor: {
        id: anchorId(id),
        type: 'anchor',
        position,
        hidden: true,
        data: { frame: id },
        ...(parentId === undefined ? {} : { parentId }),
      },
    }))
}

/** The same object for the same node: React Flow looks at another one anew. */
const anchored = new WeakMap<CanvasNode, CanvasNode>()

function onAnchor(node: CanvasNode, frame: string): CanvasNode {
  const known = anchored.get(node)
  if (known) return known
  const made = { ...node, parentId: anchorId(frame) }
  anchored.set(node, made)
  return made
}

/** The nodes with an anchor for each frame, directly behind it, and what is directly in the frame on it. */
export function withAnchors(nodes: readonly CanvasNode[], frames: readonly DraggedFrame[]): CanvasNode[] {
  const anchors = new Map(frames.map(({ path, anchor }) => [path, anchor]))
  return nodes.flatMap((node) => {
    const { parentId } = node
    const drawn = parentId !== undefined && anchors.has(parentId) ? onAnchor(node, parentId) : node
    const anchor = anchors.get(node.id)
    return anchor ? [drawn, anchor] : [drawn]
  })
}

/** Is a node or an arrow, by its id, drawn in a container? */
export function isInside(id: string, path: string): boolean {
  return id.startsWith(path) && '/#|~'.includes(id.charAt(path.length) || ' ')
}

/** The elements that draw what is in a container. */
export function elementsInside(canvas: HTMLElement, path: string): readonly (HTMLElement | SVGElement)[] {
  const drawn = [...canvas.querySelectorAll<HTMLElement | SVGElement>('.react-flow__node, .react-flow__edge')]
  return drawn
    .filter((each) => isInside(each.dataset['id'] ?? '', path))
    .map((each) => (each instanceof SVGElement ? (each.ownerSVGElement ?? each) : each))
}

/** How far a frame has come from its anchor. */
export function shiftOfFrame(frame: Point, anchor: Point): string {
  return `${frame.x - anchor.x}px ${frame.y - anchor.y}px`
}

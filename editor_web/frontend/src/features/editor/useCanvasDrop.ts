/** Putting something new on the canvas: dropped from the library, on an arrow or in a container; or asked for by the menu. */
import { useReactFlow } from '@xyflow/react'
import type { DragEvent, MouseEvent as ReactMouseEvent } from 'react'
import { edgeOf, sourceOf } from '../../document/edgeId'
import { isForeign, isHolder, nodeOf } from '../../document/editing/model'
import type { Point } from '../../document/geometry'
import { add, choose, type Addition } from './actions'
import { frameAt, positionIn, type DrawnCanvas } from './canvasPlaces'
import { ADDITION } from './dragging'
import { openAddPalette } from './paletteRequests'
import { editor, rootOf, setEditor, showEditorRefusal } from './store'

export interface CanvasDrop {
  readonly onDragOver: (event: DragEvent) => void
  readonly onDrop: (event: DragEvent) => void
  readonly onPaneContextMenu: (event: MouseEvent | ReactMouseEvent) => void
}

export function useCanvasDrop(canvas: DrawnCanvas): CanvasDrop {
  const { screenToFlowPosition } = useReactFlow()

  function onDragOver(event: DragEvent): void {
    if (!event.dataTransfer.types.includes(ADDITION)) return
    event.preventDefault()
    event.dataTransfer.dropEffect = 'copy'
  }

  function onDrop(event: DragEvent): void {
    const dragged = event.dataTransfer.getData(ADDITION)
    if (!dragged) return
    event.preventDefault()
    const what = JSON.parse(dragged) as Addition
    const screen = { x: event.clientX, y: event.clientY }
    const edge = edgeUnder(screen)
    if (edge) {
      void add(what, { parent: edge.machine, from: { path: sourceOf(edge), outcome: edge.outcome, isInsert: true } })
      return
    }
    const at = screenToFlowPosition(screen)
    const parent = dropHolder(frameAt(canvas, at), screen)
    if (parent) void add(what, { parent, at: positionIn(canvas, parent, at) })
    else showEditorRefusal('Add', 'nothing can be put in here', 'Drop it on a container or a free place.')
  }

  function onPaneContextMenu(event: MouseEvent | ReactMouseEvent): void {
    event.preventDefault()
    const screen = { x: event.clientX, y: event.clientY }
    choose([])
    setEditor({ palette: undefined })
    openAddPalette(screen, positionIn(canvas, canvas.arranged.scope.path, screenToFlowPosition(screen)))
  }

  return { onDragOver, onDrop, onPaneContextMenu }
}

function edgeUnder(screen: Point) {
  const hit = document.elementsFromPoint(screen.x, screen.y).find((each) => each.classList.contains('react-flow__edge-interaction'))
  return edgeOf(hit?.closest('.react-flow__edge')?.getAttribute('data-id') ?? '')
}

/** What takes a dropped addition: the branch of a tree under the pointer, else the container around. */
function dropHolder(frame: string, screen: Point): string | undefined {
  const root = rootOf(editor())
  if (!root) return undefined
  const under = document
    .elementsFromPoint(screen.x, screen.y)
    .map((each) => each.closest('.react-flow__node')?.getAttribute('data-id') ?? '')
  const twig = under.map((id) => nodeOf(root, id)).find((node) => node && isHolder(node) && node.path.startsWith(frame))
  const holder = twig ?? nodeOf(root, frame)
  if (!holder || isForeign(root, `${holder.path}/x`)) return undefined
  if (isHolder(holder)) return holder.path
  const top = holder.kind === 'tree' ? holder.children[0] : undefined
  return top && isHolder(top) ? top.path : undefined
}

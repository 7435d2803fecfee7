/** What clicks and wires on the canvas do. Not made anew with each drawing, or every node would be drawn again with it. */
import type { Connection } from '@xyflow/react'
import type { MouseEvent } from 'react'
import { pointOf } from '../../components/menuPoint'
import { isEdgeId, outcomeOf } from '../../document/edgeId'
import { isHolder } from '../../document/editing/model'
import { nameOfPath, parentPath } from '../../document/path'
import { choose, chooseArrow, connect, enter, toggleOpen } from './actions'
import { openReferred } from './pageActions'
import type { CanvasEdge, CanvasNode } from './elements'
import { editor, setEditor } from './store'

export function onEdgeClick(_event: unknown, edge: CanvasEdge): void {
  if (edge.type === 'transition' && isEdgeId(edge.id)) chooseArrow(edge.id)
}

export function onNodeClick(): void {
  chooseArrow(undefined)
}

export function onPaneClick(): void {
  choose([])
  chooseArrow(undefined)
}

export function onConnect({ source, sourceHandle, target }: Connection): void {
  if (!sourceHandle) return
  void connect(source, sourceHandle, outcomeOf(target)?.outcome ?? nameOfPath(target))
}

export function onReconnect(edge: CanvasEdge, link: Connection): void {
  if (edge.source === link.source && edge.sourceHandle === link.sourceHandle) onConnect(link)
}

export function isAllowed({ source, target }: { source: string; target: string }): boolean {
  const machine = parentPath(source)
  const outcome = outcomeOf(target)
  return (outcome ? outcome.machine : parentPath(target)) === machine
}

export function onDouble(_event: unknown, node: CanvasNode): void {
  if (node.type === 'frame') enter(node.id)
  else if (node.type === 'twig') toggleOpen(node.id, node.data.isOpen)
  else if (node.type === 'leaf') {
    if (node.data.node.document) openReferred(node.data.node.document, node.id)
    else if (node.data.count > 0 || isHolder(node.data.node)) enter(node.id)
    else setEditor({ renaming: node.id })
  }
}

/** The menu of a node, which is selected with it; of all selected ones where it is one of them. */
export function onNodeMenu(event: MouseEvent, node: CanvasNode): void {
  if (node.type === 'pill' || node.type === 'rules') return
  if (!editor().selection.includes(node.id)) choose([node.id])
  onSelectionMenu(event)
}

export function onSelectionMenu(event: MouseEvent): void {
  event.preventDefault()
  setEditor({ menu: pointOf(event) })
}

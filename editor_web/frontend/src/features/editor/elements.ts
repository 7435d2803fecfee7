/** From an arranged document to the canvas's nodes and edges. */
import { Position, type Edge, type Node } from '@xyflow/react'
import { arrowId, outcomeId } from '../../document/layout'
import { rulesId, type Arrangement } from '../../document/editing/arrange'
import { entryY, pillsOf } from '../../document/editing/measure'
import {
  isFailure,
  isFrame,
  isMachine,
  isTreePart,
  nodeOf,
  parentPath,
  waysOf,
  type EditNode,
  type Way,
} from '../../document/editing/model'
import { countInside, drawnNodes, frameOf } from '../../document/editing/opening'
import type { Point } from '../../document/geometry'
import { kindLabel } from '../../document/tree'

export interface CardData extends Record<string, unknown> {
  readonly node: EditNode
  readonly ways: readonly Way[]
  /** Ways that an arrow is drawn for; the others say where they lead. */
  readonly drawn: ReadonlySet<string>
  readonly isInitial: boolean
  readonly isOpen: boolean
  readonly isForeign: boolean
  readonly isInTree: boolean
  readonly count: number
  /** Where arrows come in, from above. */
  readonly entryY: number
}

export type CardNode = Node<CardData, 'leaf' | 'frame' | 'twig'>
export type PillNode = Node<{ machine: string; outcome: string; count: number }, 'pill'>
export type RulesNode = Node<{ node: EditNode }, 'rules'>
export type CanvasNode = CardNode | PillNode | RulesNode
export type WayEdge = Edge<
  { points: readonly Point[] | undefined; outcome: string; machine: string; isQuiet: boolean },
  'way'
>
export type BranchEdge = Edge<Record<string, unknown>, 'branch'>
export type CanvasEdge = WayEdge | BranchEdge

export const IN = 'in'

export interface DrawnInput {
  readonly root: EditNode
  readonly scope: EditNode
  readonly arrangement: Arrangement
  readonly isOpen: (path: string) => boolean
  readonly declared: (node: EditNode) => readonly string[]
}

/** All nodes, parents before children. */
export function canvasNodes(input: DrawnInput): readonly CanvasNode[] {
  const { scope, arrangement, isOpen } = input
  const shown = drawnNodes(scope, isOpen)
  const cards = shown.flatMap((node) => card(node, input))
  const machines = [scope, ...shown.filter((node) => isMachine(node.kind) && isOpen(node.path))]
  const pills = machines.flatMap((machine) => pillNodes(machine, input))
  const table = arrangement.boxes.get(rulesId(scope.path))
  const rules: RulesNode[] = table
    ? [
        {
          id: rulesId(scope.path),
          type: 'rules',
          position: table,
          width: table.width,
          height: table.height,
          data: { node: scope },
          draggable: false,
          selectable: false,
          focusable: false,
        },
      ]
    : []
  return [...cards, ...pills, ...rules]
}

function card(node: EditNode, { root, scope, arrangement, isOpen }: DrawnInput): CardNode[] {
  const box = arrangement.boxes.get(node.path)
  const parent = nodeOf(root, parentPath(node.path))
  if (!box || !parent) return []
  const frame = frameOf(scope, node.path)
  const ways = waysOf(parent, node)
  const { drawn } = pillsOf(parent, [])
  const inside = new Set([...parent.children.map((child) => child.name), ...drawn])
  const isTwig = isTreePart(node.kind) && node.kind !== 'tree'
  const isForeignNode = isBelowReference(root, node.path)
  const isShown = isOpen(node.path) && isFrame(node)
  return [
    {
      id: node.path,
      type: isTwig ? 'twig' : isShown ? 'frame' : 'leaf',
      position: { x: box.x, y: box.y },
      width: box.width,
      height: box.height,
      ...(frame === scope ? {} : { parentId: frame.path }),
      draggable: !isForeignNode,
      data: {
        node,
        ways,
        drawn: new Set(
          ways.filter((way) => way.target !== undefined && inside.has(way.target)).map((way) => way.outcome),
        ),
        isInitial: isMachine(parent.kind) && parent.initial === node.name,
        isOpen: isTwig ? isOpen(node.path) : isShown,
        isForeign: isForeignNode,
        isInTree: isTreePart(parent.kind),
        count: countInside(node),
        entryY: entryY(box.height, ways.length),
      },
      ariaLabel: spoken(node, ways),
      sourcePosition: Position.Right,
      targetPosition: Position.Left,
    },
  ]
}

function isBelowReference(root: EditNode, path: string): boolean {
  for (let above = parentPath(path); above; above = parentPath(above)) {
    if (nodeOf(root, above)?.kind === 'behavior') return true
  }
  return false
}

function spoken(node: EditNode, ways: readonly Way[]): string {
  const leads = ways.map((way) => `${way.outcome} ${way.target === undefined ? 'not connected' : `to ${way.target}`}`)
  const inside = node.children.length > 0 ? `, ${countInside(node)} nodes inside` : ''
  return `${kindLabel(node.kind)} ${node.name}${node.title ? `, runs ${node.title}` : ''}${inside}${leads.length > 0 ? `; ${leads.join(', ')}` : ''}`
}

function pillNodes(machine: EditNode, { scope, arrangement, declared }: DrawnInput): PillNode[] {
  const { drawn, gathered } = pillsOf(machine, declared(machine))
  return [...drawn, ...gathered].flatMap((outcome) => {
    const box = arrangement.boxes.get(outcomeId(machine.path, outcome))
    if (!box) return []
    const count = machine.transitions.filter((t) => t.target === outcome).length
    return [
      {
        id: outcomeId(machine.path, outcome),
        type: 'pill' as const,
        position: { x: box.x, y: box.y },
        width: box.width,
        height: box.height,
        ...(machine === scope ? {} : { parentId: machine.path }),
        draggable: false,
        selectable: false,
        focusable: false,
        data: { machine: machine.path, outcome, count },
        ariaLabel: `Outcome ${outcome} of ${machine.name}, ${count} lead here`,
        targetPosition: Position.Left,
      },
    ]
  })
}

/** The arrows of machines and the lines of trees. Arrows to an outcome that many lead to are drawn for the chosen nodes only. */
export function canvasEdges(input: DrawnInput, selection: readonly string[]): readonly CanvasEdge[] {
  const { scope, isOpen } = input
  const open = [scope, ...drawnNodes(scope, isOpen).filter((node) => isOpen(node.path))]
  const chosen = new Set(selection)
  return open.flatMap((node): readonly CanvasEdge[] =>
    isMachine(node.kind) ? ways(node, input, chosen) : isTreePart(node.kind) ? branches(node) : [],
  )
}

function ways(machine: EditNode, { arrangement, declared }: DrawnInput, chosen: ReadonlySet<string>): WayEdge[] {
  const paths = new Map(machine.children.map((child) => [child.name, child.path]))
  const { drawn, gathered } = pillsOf(machine, declared(machine))
  return machine.transitions.flatMap((t) => {
    const source = paths.get(t.source)
    const isQuiet = gathered.includes(t.target) && !paths.has(t.target)
    const target =
      paths.get(t.target) ?? (drawn.includes(t.target) || isQuiet ? outcomeId(machine.path, t.target) : undefined)
    if (!source || !target || !arrangement.boxes.has(target) || (isQuiet && !chosen.has(source))) return []
    const id = arrowId(machine.path, t.source, t.outcome)
    return [
      {
        id,
        type: 'way' as const,
        source,
        target,
        sourceHandle: t.outcome,
        targetHandle: IN,
        data: { points: arrangement.routes.get(id), outcome: t.outcome, machine: machine.path, isQuiet },
        className: isFailure(t.outcome) ? 'is-failure' : '',
        ariaLabel: `${t.outcome} of ${t.source} leads to ${t.target}`,
        // From its port an arrow is drawn anew; only its head is taken elsewhere.
        reconnectable: 'target' as const,
        // What lies below nodes does not catch what is meant for their ports.
        ...(isQuiet ? { zIndex: 3, selectable: false } : {}),
      },
    ]
  })
}

function branches(node: EditNode): BranchEdge[] {
  if (node.kind === 'tree') return []
  return node.children.map((child, index) => ({
    id: `${node.path}~${child.name}`,
    type: 'branch' as const,
    source: node.path,
    target: child.path,
    sourceHandle: 'below',
    targetHandle: 'above',
    ariaLabel: `${child.name} is child ${index + 1} of ${node.name}`,
    selectable: false,
    focusable: false,
    deletable: false,
    reconnectable: false,
  }))
}

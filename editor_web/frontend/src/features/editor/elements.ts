/** From an arranged document to the canvas's nodes and edges. */
import { Position, type Edge, type Node, type NodeHandle } from '@xyflow/react'
import { edgeId, outcomeId } from '../../document/edgeId'
import { rulesId, type Arrangement } from '../../document/editing/arrange'
import { entryY, PILL_HEIGHT, pillsOf, portY } from '../../document/editing/measure'
import {
  isForeign,
  isFrame,
  isMachine,
  isTreePart,
  outgoingTransitions,
  type EditNode,
  type OutgoingTransition,
} from '../../document/editing/model'
import { disabledText, isPassedOver } from '../../document/editing/disabling'
import { countInside, drawnNodes } from '../../document/editing/expansion'
import type { Box, Point } from '../../document/geometry'
import { kindLabel } from '../../document/tree'
import { parentPath } from '../../document/path'

export interface CardData extends Record<string, unknown> {
  readonly node: EditNode
  readonly transitions: readonly OutgoingTransition[]
  /** Ways that an arrow is drawn for; the others say where they lead. */
  readonly drawn: ReadonlySet<string>
  readonly isInitial: boolean
  readonly isOpen: boolean
  readonly isForeign: boolean
  /** It is disabled, or something around it is. */
  readonly isPassedOver: boolean
  readonly isInTree: boolean
  readonly count: number
  /** Where arrows come in, from above. */
  readonly entryY: number
}

export type CardNode = Node<CardData, 'leaf' | 'frame' | 'twig'>
export type PillNode = Node<{ machine: string; outcome: string; count: number }, 'pill'>
export type RulesNode = Node<{ node: EditNode }, 'rules'>
/** Not drawn: what is in a container hangs on it while the container is dragged. */
export type AnchorNode = Node<{ frame: string }, 'anchor'>
export type CanvasNode = CardNode | PillNode | RulesNode | AnchorNode
export type TransitionEdge = Edge<
  { points: readonly Point[] | undefined; outcome: string; machine: string; isQuiet: boolean },
  'transition'
>
export type BranchEdge = Edge<Record<string, unknown>, 'branch'>
export type CanvasEdge = TransitionEdge | BranchEdge

export const IN = 'in'
/** Width and height of the port of an outcome. */
const PORT = 11

export interface DrawnInput {
  readonly root: EditNode
  readonly scope: EditNode
  readonly arrangement: Arrangement
  readonly isOpen: (path: string) => boolean
  readonly declared: (node: EditNode) => readonly string[]
}

/** The cards of nodes as they were drawn last: a node that stays the same object, in the same surroundings, keeps its card. */
export type KeptCards = WeakMap<EditNode, { readonly place: Place; readonly drawn: CardNode }>

/** All nodes, parents before children; `kept` are the cards of the times before. */
export function canvasNodes(input: DrawnInput, kept: KeptCards = new WeakMap()): readonly CanvasNode[] {
  const { root, scope, arrangement, isOpen } = input
  const shown = drawnNodes(scope, isOpen)
  const around = new Map([
    [scope.path, surroundings(scope, scope, isForeign(root, scope.path), isPassedOver(root, parentPath(scope.path)))],
  ])
  const cards = shown.flatMap((node): readonly CardNode[] => {
    const [outside, isShown] = [around.get(parentPath(node.path)), isOpen(node.path)]
    if (!outside) return []
    if (isShown) {
      const frame = isBranch(node) ? outside.frame : node
      around.set(node.path, surroundings(node, frame, outside.isForeign, outside.isPassedOver))
    }
    const box = arrangement.boxes.get(node.path)
    return box ? [keptCard(node, { box, outside, scope: scope.path, isOpen: isShown }, kept)] : []
  })
  const machines = [scope, ...shown.filter((node) => isMachine(node.kind) && isOpen(node.path))]
  const pills = machines.flatMap((machine) => pillNodes(machine, input))
  const table = arrangement.boxes.get(rulesId(scope.path))
  const rules: RulesNode[] = table
    ? [
        {
          id: rulesId(scope.path),
          type: 'rules',
          position: table,
          ...sized(table),
          data: { node: scope },
          draggable: false,
          selectable: false,
          focusable: false,
        },
      ]
    : []
  return [...cards, ...pills, ...rules]
}

/** What a node is to those directly inside it. */
interface Surroundings {
  readonly parent: EditNode
  /** The container in whose frame they are drawn. */
  readonly frame: EditNode
  /** What an arrow can be drawn to. */
  readonly ends: ReadonlySet<string>
  readonly isForeign: boolean
  readonly isPassedOver: boolean
}

/** What the card of a node follows from, besides the node. */
interface Place {
  readonly box: Box
  readonly outside: Surroundings
  /** The path of what fills the canvas. */
  readonly scope: string
  readonly isOpen: boolean
}

function surroundings(parent: EditNode, frame: EditNode, isForeignAbove: boolean, isPassedOverAbove: boolean): Surroundings {
  const { drawn } = pillsOf(parent, [])
  return {
    parent,
    frame,
    ends: new Set([...parent.children.map((child) => child.name), ...drawn]),
    isForeign: isForeignAbove || parent.kind === 'behavior',
    isPassedOver: isPassedOverAbove || parent.disabled !== false,
  }
}

/** A branch of a tree is no container of its own: what is below it is drawn in the frame of the tree. */
function isBranch(node: EditNode): boolean {
  return isTreePart(node.kind) && node.kind !== 'tree'
}

function isSamePlace(one: Place, other: Place): boolean {
  const [a, b] = [one.outside, other.outside]
  return (
    a.parent === b.parent &&
    a.frame.path === b.frame.path &&
    a.isForeign === b.isForeign &&
    a.isPassedOver === b.isPassedOver &&
    one.scope === other.scope &&
    one.isOpen === other.isOpen &&
    isSameBox(one.box, other.box)
  )
}

function isSameBox(one: Box, other: Box): boolean {
  return one.x === other.x && one.y === other.y && one.width === other.width && one.height === other.height
}

function keptCard(node: EditNode, place: Place, kept: KeptCards): CardNode {
  const before = kept.get(node)
  if (before && isSamePlace(before.place, place)) return before.drawn
  const drawn = card(node, place)
  kept.set(node, { place, drawn })
  return drawn
}

function card(node: EditNode, { box, outside, scope, isOpen }: Place): CardNode {
  const { parent, frame, ends } = outside
  const transitions = outgoingTransitions(parent, node)
  const isTwig = isBranch(node)
  const isShown = isOpen && isFrame(node)
  const isInTree = isTreePart(parent.kind)
  return {
    id: node.path,
    type: isTwig ? 'twig' : isShown ? 'frame' : 'leaf',
    position: { x: box.x, y: box.y },
    ...sized(box),
    handles: isTwig || isInTree ? twigHandles(box) : transitionHandles(box, transitions),
    ...(frame.path === scope ? {} : { parentId: frame.path }),
    draggable: !outside.isForeign,
    data: {
      node,
      transitions,
      drawn: new Set(transitions.filter((each) => each.target !== undefined && ends.has(each.target)).map((each) => each.outcome)),
      isInitial: isMachine(parent.kind) && parent.initial === node.name,
      isOpen: isTwig ? isOpen : isShown,
      isForeign: outside.isForeign,
      isPassedOver: outside.isPassedOver || node.disabled !== false,
      isInTree,
      count: countInside(node),
      entryY: entryY(box.height, transitions.length),
    },
    ariaLabel: spoken(node, transitions),
    sourcePosition: Position.Right,
    targetPosition: Position.Left,
  }
}

/** Said beforehand, so that the canvas needs not look at what it draws, nor draw what nobody sees. */
function sized({ width, height }: Box): Pick<CanvasNode, 'width' | 'height' | 'measured'> {
  return { width, height, measured: { width, height } }
}

/** Where ports are in the node, as its styles put them. */
function transitionHandles(box: Box, transitions: readonly OutgoingTransition[]): NodeHandle[] {
  const outs = transitions.map(({ outcome }, row): NodeHandle => ({
    id: outcome,
    type: 'source',
    position: Position.Right,
    x: box.width - PORT / 2 - 0.5,
    y: portY(box.height, transitions.length, row) - PORT / 2,
    width: PORT,
    height: PORT,
  }))
  return [inHandle(entryY(box.height, transitions.length)), ...outs]
}

function inHandle(y: number): NodeHandle {
  return { id: IN, type: 'target', position: Position.Left, x: -2, y: y - 2, width: 7, height: 7 }
}

function twigHandles({ width, height }: Box): NodeHandle[] {
  const x = width / 2 - 0.5
  return [
    { id: 'above', type: 'target', position: Position.Top, x, y: -0.5, width: 1, height: 1 },
    { id: 'below', type: 'source', position: Position.Bottom, x, y: height - 0.5, width: 1, height: 1 },
  ]
}

function spoken(node: EditNode, transitions: readonly OutgoingTransition[]): string {
  const leads = transitions.map((each) => `${each.outcome} ${each.target === undefined ? 'not connected' : `to ${each.target}`}`)
  const inside = node.children.length > 0 ? `, ${countInside(node)} nodes inside` : ''
  const off = node.disabled === false ? '' : `, ${disabledText(node.disabled)}`
  return `${kindLabel(node.kind)} ${node.name}${off}${node.title ? `, runs ${node.title}` : ''}${inside}${leads.length > 0 ? `; ${leads.join(', ')}` : ''}`
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
        ...sized(box),
        handles: [inHandle(PILL_HEIGHT / 2)],
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
    isMachine(node.kind) ? transitionEdges(node, input, chosen) : isTreePart(node.kind) ? branches(node) : [],
  )
}

function transitionEdges(machine: EditNode, { arrangement, declared }: DrawnInput, chosen: ReadonlySet<string>): TransitionEdge[] {
  const paths = new Map(machine.children.map((child) => [child.name, child.path]))
  const { drawn, gathered } = pillsOf(machine, declared(machine))
  return machine.transitions.flatMap((t) => {
    const source = paths.get(t.source)
    const isQuiet = gathered.includes(t.target) && !paths.has(t.target)
    const target = paths.get(t.target) ?? (drawn.includes(t.target) || isQuiet ? outcomeId(machine.path, t.target) : undefined)
    if (!source || !target || !arrangement.boxes.has(target) || (isQuiet && !chosen.has(source))) return []
    const id = edgeId({ machine: machine.path, source: t.source, outcome: t.outcome })
    return [
      {
        id,
        type: 'transition' as const,
        source,
        target,
        sourceHandle: t.outcome,
        targetHandle: IN,
        data: { points: arrangement.routes.get(id), outcome: t.outcome, machine: machine.path, isQuiet },
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

/**
 * Where everything goes: sizes and positions of nodes, and the courses of arrows.
 *
 * One layout call per container, from the inside out: transitions never cross a container's border,
 * they end at its outcomes. Positions are relative to the parent; courses are absolute.
 */
import type { GraphNode, GraphTransition } from '../api/types'
import { layOutBranching, OUTCOME_HEIGHT, type Direction, type Style } from './branching'
import { chainOf, layOutChain } from './chain'
import { flowOf, type Flow } from './flow'
import { edgeId, outcomeId } from './edgeId'
import type { LayoutCall } from './elkGraph'
import { moved, type Box, type Point, type Size } from './geometry'
import { widthFrom } from './rows'
import { kindLabel } from './tree'

/** An outcome of a machine that is written on the node instead of drawn as an arrow. */
export interface Exit {
  readonly outcome: string
  readonly target: string
}

/** An arrow of a machine as it is drawn. */
export interface Course {
  readonly id: string
  readonly machine: string
  readonly source: string
  readonly target: string
  readonly outcome: string
  readonly points: readonly Point[]
  readonly label: Point
}

export interface Layout {
  readonly size: Size
  /** Relative to the parent, by node path; outcomes of a machine are at `path#outcome`. */
  readonly boxes: ReadonlyMap<string, Box>
  readonly courses: readonly Course[]
}

const LEAF_HEIGHT = 74
/** Arrows of a row come and go at the middle of its states, and at the height of that beside what is taller. */
const AXIS = LEAF_HEIGHT / 2
const EXIT_LINE = 22
/** States are as wide as one of these, so that a longer name seldom moves what is beside it. */
const LEAF_WIDTHS = [160, 220, 280] as const
/** The icon before the name, with what it stands apart. */
const KIND_ICON = 23
const HEADER = 38
const PADDING = 14
/** From the border of a machine to its first row. */
const SIDE = 16
const ABOVE = 6
const GAP = 12
const CONDITION_LINE = 20

/** Width of `characters` of the interface's font at 12 px, measured on the safe side. */
function textWidth(characters: number, perCharacter = 7.2): number {
  return Math.ceil(characters * perCharacter)
}

function outcomeWidth(outcome: string): number {
  return textWidth(outcome.length) + 34
}

function labelWidth(outcome: string): number {
  return textWidth(outcome.length, 6.6) + 10
}

/**
 * The outcomes of a machine that get a place of their own on the canvas: those that one arrow leads to.
 * Arrows to the others, typically one from every state to `failed`, are written on the states.
 */
export function drawnOutcomes(parent: GraphNode): readonly string[] {
  const inside = new Set(parent.children.map((child) => child.name))
  return parent.outcomes.filter((outcome) => !inside.has(outcome) && parent.transitions.filter((t) => t.target === outcome).length === 1)
}

function drawnTransitions(parent: GraphNode): readonly GraphTransition[] {
  const drawn = new Set([...drawnOutcomes(parent), ...parent.children.map((child) => child.name)])
  return parent.transitions.filter((t) => drawn.has(t.target))
}

/** The outcomes of `parent` that are written on its child `name`. */
export function exitsOf(parent: GraphNode | undefined, name: string): readonly Exit[] {
  if (parent?.kind !== 'machine') return []
  const drawn = new Set([...drawnOutcomes(parent), ...parent.children.map((child) => child.name)])
  return parent.transitions.filter((t) => t.source === name && !drawn.has(t.target))
}

/** Lay out a whole behavior. */
export async function layOut(root: GraphNode, style: Style, call: LayoutCall): Promise<Layout> {
  const inner = await layOutNode(root, undefined, style, call)
  return { size: { width: inner.width, height: inner.height }, boxes: inner.boxes, courses: inner.courses }
}

interface Inner {
  width: number
  height: number
  boxes: Map<string, Box>
  courses: Course[]
}

async function layOutNode(node: GraphNode, parent: GraphNode | undefined, style: Style, call: LayoutCall): Promise<Inner> {
  const inner = await layOutInside(node, { ...style, rowLimit: style.rowLimit - 2 * PADDING }, call)
  const exits = exitsOf(parent, node.name)
  if (exits.length === 0) return inner
  return { ...inner, width: Math.max(inner.width, exitsWidth(exits)), height: inner.height + EXIT_LINE }
}

function exitsWidth(exits: readonly Exit[]): number {
  const texts = exits.map(({ outcome, target }) => (outcome === target ? outcome : `${outcome} → ${target}`))
  return texts.reduce((sum, text) => sum + textWidth(text.length, 6.2) + 26, 16)
}

async function layOutInside(node: GraphNode, style: Style, call: LayoutCall): Promise<Inner> {
  if (node.children.length === 0) return leaf(node)
  const inside = await Promise.all(node.children.map((child) => layOutNode(child, node, style, call)))
  return node.kind === 'machine' ? machine(node, inside, style, call) : regions(node, inside, style.direction)
}

function leaf(node: GraphNode): Inner {
  const preferred = Math.max(textWidth(node.name.length, 8) + KIND_ICON, textWidth(node.title.length, 6.6)) + 64
  const width = widthFrom(LEAF_WIDTHS, preferred)
  return { width, height: LEAF_HEIGHT, boxes: new Map(), courses: [] }
}

function headerWidth(node: GraphNode): number {
  return textWidth(node.name.length, 8.8) + textWidth(kindLabel(node.kind).length, 6.4) + 150
}

/** Children of anything but a machine stand side by side, across the flow. */
function regions(node: GraphNode, inside: readonly Inner[], direction: Direction): Inner {
  const footer = node.conditions.length > 0 ? CONDITION_LINE : 0
  const boxes = new Map<string, Box>()
  const courses: Course[] = []
  let x = PADDING
  let y = HEADER + 4
  const widest = Math.max(headerWidth(node) - 2 * PADDING, ...inside.map((child) => child.width))
  const breadth = direction === 'RIGHT' ? widest : Math.max(...inside.map((child) => child.height))
  node.children.forEach((child, index) => {
    const size = inside[index]
    if (!size) return
    const width = direction === 'RIGHT' ? breadth : size.width
    const height = direction === 'RIGHT' ? size.height : breadth
    place(
      child.path,
      { x, y, width: child.children.length > 0 ? size.width : width, height: child.children.length > 0 ? size.height : height },
      size,
      boxes,
      courses,
    )
    if (direction === 'RIGHT') y += size.height + GAP
    else x += size.width + GAP
  })
  const contentWidth = direction === 'RIGHT' ? breadth + 2 * PADDING : x - GAP + PADDING
  const contentHeight = direction === 'RIGHT' ? y - GAP + PADDING : HEADER + 4 + breadth + PADDING
  return {
    width: Math.max(contentWidth, headerWidth(node)),
    height: contentHeight + footer,
    boxes,
    courses,
  }
}

async function machine(node: GraphNode, inside: readonly Inner[], style: Style, call: LayoutCall): Promise<Inner> {
  const flow = flowOf(
    node.children.map((child) => child.name),
    drawnTransitions(node),
    node.initial,
  )
  const units: Units = new Map(
    node.children.flatMap((child, index) => (inside[index] ? [[child.name, { child, inner: inside[index] }]] : [])),
  )
  const chain = style.direction === 'RIGHT' ? chainOf(flow, drawnTransitions(node), drawnOutcomes(node)) : undefined
  const drawn = chain ? straightMachine(node, units, flow, chain, style.rowLimit) : await branchingMachine(node, units, flow, style, call)
  standAside(drawn, units, flow.loose, style.rowLimit)
  return { ...drawn, width: Math.max(drawn.width, headerWidth(node)), height: drawn.height + PADDING }
}

/** The children of a machine by name, as large as they are. */
type Units = ReadonlyMap<string, { readonly child: GraphNode; readonly inner: Inner }>

/** The children that nothing leads to or from, in rows of their own below the others. */
function standAside(drawn: Inner, units: Units, loose: readonly string[], rowLimit: number): void {
  let [x, y, below] = [PADDING + SIDE, drawn.height + GAP, drawn.height]
  for (const name of loose) {
    const unit = units.get(name)
    if (!unit) continue
    const { width, height } = unit.inner
    if (x > PADDING + SIDE && x + width > rowLimit) [x, y] = [PADDING + SIDE, below + GAP]
    place(unit.child.path, { x, y, width, height }, unit.inner, drawn.boxes, drawn.courses)
    x += width + 2 * GAP
    below = Math.max(below, y + height)
    drawn.width = Math.max(drawn.width, x - 2 * GAP + PADDING)
  }
  drawn.height = below
}

async function branchingMachine(node: GraphNode, units: Units, flow: Flow, style: Style, call: LayoutCall): Promise<Inner> {
  const sizes = new Map([...units].map(([name, { inner }]) => [name, inner]))
  const outcomes = new Map(drawnOutcomes(node).map((outcome) => [outcome, outcomeWidth(outcome)]))
  const rows = await layOutBranching({ machine: node, flow, sizes, outcomes, labelWidth, axis: AXIS }, style, call)
  const shift = { x: PADDING, y: HEADER + ABOVE }
  const boxes = new Map<string, Box>()
  const courses: Course[] = []
  const inners = new Map([...units.values()].map(({ child, inner }) => [child.path, inner]))
  for (const [id, box] of rows.boxes) place(id, { ...box, ...moved(box, shift) }, inners.get(id), boxes, courses)
  for (const { id, source, target, outcome, points, label } of rows.lines) {
    const shifted = { points: points.map((point) => moved(point, shift)), label: moved(label, shift) }
    courses.push({ id, machine: node.path, source, target, outcome, ...shifted })
  }
  return { width: rows.width + 2 * PADDING, height: shift.y + rows.height, boxes, courses }
}

function straightMachine(node: GraphNode, units: Units, flow: Flow, chain: readonly GraphTransition[], rowLimit: number): Inner {
  const names = [flow.order[0] ?? '', ...chain.map((t) => t.target)]
  const items = names.map((name) => {
    const unit = units.get(name)
    if (!unit) {
      return { id: outcomeId(node.path, name), width: outcomeWidth(name), height: OUTCOME_HEIGHT, axis: OUTCOME_HEIGHT / 2 }
    }
    return { id: unit.child.path, width: unit.inner.width, height: unit.inner.height, axis: AXIS }
  })
  const laidOut = layOutChain(items, chain, labelWidth, rowLimit)
  const shift = { x: PADDING, y: HEADER }
  const boxes = new Map<string, Box>()
  const courses: Course[] = []
  const inners = new Map([...units.values()].map(({ child, inner }) => [child.path, inner]))
  for (const [id, box] of laidOut.boxes) place(id, { ...box, ...moved(box, shift) }, inners.get(id), boxes, courses)
  laidOut.arrows.forEach((arrow, index) => {
    const { source, outcome } = arrow.transition
    courses.push({
      id: edgeId({ machine: node.path, source, outcome }),
      machine: node.path,
      source: items[index]?.id ?? '',
      target: items[index + 1]?.id ?? '',
      outcome,
      points: arrow.points.map((point) => moved(point, shift)),
      label: moved(arrow.label, shift),
    })
  })
  return { width: laidOut.width + 2 * PADDING, height: laidOut.height + HEADER, boxes, courses }
}

/** Put a laid-out node at its place, and shift the courses of what is inside it with it. */
function place(id: string, box: Box, inner: Inner | undefined, boxes: Map<string, Box>, courses: Course[]): void {
  boxes.set(id, box)
  if (!inner) return
  for (const [path, inside] of inner.boxes) boxes.set(path, inside)
  for (const course of inner.courses) {
    courses.push({ ...course, points: course.points.map((p) => moved(p, box)), label: moved(course.label, box) })
  }
}

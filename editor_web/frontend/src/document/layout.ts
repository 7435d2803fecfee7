/**
 * Where everything goes: sizes and positions of nodes, and the courses of arrows.
 *
 * One layout call per container, from the inside out: transitions never cross a container's border,
 * they end at its outcomes. Positions are relative to the parent; courses are absolute.
 */
import type { GraphNode, GraphTransition } from '../api/types'
import { chainOf, layOutChain } from './chain'
import { edgeId, edgeOf, outcomeId } from './edgeId'
import { moved, type Box, type Point, type Size } from './geometry'
import { kindLabel } from './tree'

export type Direction = 'RIGHT' | 'DOWN'

export interface ElkShape {
  id: string
  width?: number
  height?: number
  x?: number
  y?: number
  children?: ElkShape[]
  edges?: ElkArrow[]
  layoutOptions?: Record<string, string>
}

export interface ElkArrow {
  id: string
  sources: string[]
  targets: string[]
  labels?: { text: string; width: number; height: number; x?: number; y?: number }[]
  sections?: { startPoint: Point; endPoint: Point; bendPoints?: Point[] }[]
}

/** An outcome of a machine that is written on the node instead of drawn as an arrow. */
export interface Exit {
  readonly outcome: string
  readonly target: string
}

/** Lays out one flat graph; elk's `layout`. */
export type LayoutCall = (graph: ElkShape) => Promise<ElkShape>

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
const EXIT_LINE = 22
const LEAF_MIN = 156
const LEAF_MAX = 280
const HEADER = 38
const PADDING = 14
const GAP = 12
const CONDITION_LINE = 20
const OUTCOME_HEIGHT = 28
const LABEL_HEIGHT = 16

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

/** How a behavior is laid out; a chain longer than `rowLimit` pixels goes on in a further row. */
export interface Style {
  readonly direction: Direction
  readonly rowLimit: number
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
  const preferred = Math.max(textWidth(node.name.length, 8), textWidth(node.title.length, 6.6)) + 64
  const width = Math.min(LEAF_MAX, Math.max(LEAF_MIN, preferred))
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
  const chain = style.direction === 'RIGHT' ? chainOf(node, drawnTransitions(node), drawnOutcomes(node)) : undefined
  if (chain) return straightMachine(node, inside, chain, style.rowLimit)
  const laidOut = await call(machineGraph(node, inside, style))
  const boxes = new Map<string, Box>()
  const courses: Course[] = []
  const shift = { x: PADDING, y: HEADER }
  const sizes = new Map(node.children.map((child, index) => [child.path, inside[index]]))
  for (const shape of laidOut.children ?? []) {
    const { x = 0, y = 0, width = 0, height = 0 } = shape
    place(shape.id, { x: x + shift.x, y: y + shift.y, width, height }, sizes.get(shape.id), boxes, courses)
  }
  for (const arrow of laidOut.edges ?? []) {
    const course = courseOf(node, arrow, shift)
    if (course) courses.push(course)
  }
  return {
    width: Math.max((laidOut.width ?? 0) + 2 * PADDING, headerWidth(node)),
    height: (laidOut.height ?? 0) + HEADER + PADDING,
    boxes,
    courses,
  }
}

function straightMachine(node: GraphNode, inside: readonly Inner[], chain: readonly GraphTransition[], rowLimit: number): Inner {
  const sizes = new Map(node.children.map((child, index) => [child.name, { id: child.path, inner: inside[index] }]))
  const names = [chain[0]?.source ?? node.children[0]?.name ?? '', ...chain.map((t) => t.target)]
  const items = names.map((name) => {
    const child = sizes.get(name)
    if (!child?.inner) return { id: outcomeId(node.path, name), width: outcomeWidth(name), height: OUTCOME_HEIGHT }
    return { id: child.id, width: child.inner.width, height: child.inner.height }
  })
  const laidOut = layOutChain(items, chain, labelWidth, rowLimit)
  const shift = { x: PADDING, y: HEADER }
  const boxes = new Map<string, Box>()
  const courses: Course[] = []
  const inners = new Map([...sizes.values()].map((child) => [child.id, child.inner]))
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
  return {
    width: Math.max(laidOut.width + 2 * PADDING, headerWidth(node)),
    height: laidOut.height + HEADER + PADDING,
    boxes,
    courses,
  }
}

function machineGraph(node: GraphNode, inside: readonly Inner[], style: Style): ElkShape {
  const paths = new Map(node.children.map((child) => [child.name, child.path]))
  const children: ElkShape[] = node.children.map((child, index) => ({
    id: child.path,
    width: inside[index]?.width ?? 0,
    height: inside[index]?.height ?? 0,
    // The first state opens the flow, whatever order the document has.
    ...(child.name === node.initial ? { layoutOptions: { 'elk.layered.layering.layerConstraint': 'FIRST' } } : {}),
  }))
  const drawn = drawnOutcomes(node)
  for (const outcome of drawn) {
    children.push({ id: outcomeId(node.path, outcome), width: outcomeWidth(outcome), height: OUTCOME_HEIGHT })
  }
  const edges = node.transitions.flatMap((t) => {
    const source = paths.get(t.source)
    const target = paths.get(t.target) ?? (drawn.includes(t.target) ? outcomeId(node.path, t.target) : undefined)
    if (!source || !target) return []
    return [
      {
        id: edgeId({ machine: node.path, source: t.source, outcome: t.outcome }),
        sources: [source],
        targets: [target],
        labels: [{ text: t.outcome, width: labelWidth(t.outcome), height: LABEL_HEIGHT }],
      },
    ]
  })
  return { id: node.path, children, edges, layoutOptions: options(style) }
}

function options({ direction }: Style): Record<string, string> {
  return {
    'elk.algorithm': 'layered',
    'elk.direction': direction,
    'elk.edgeRouting': 'ORTHOGONAL',
    'elk.padding': '[top=6,left=0,bottom=0,right=0]',
    'elk.spacing.nodeNode': '24',
    'elk.spacing.edgeNode': '14',
    'elk.spacing.edgeEdge': '12',
    'elk.layered.spacing.nodeNodeBetweenLayers': '20',
    'elk.layered.spacing.edgeNodeBetweenLayers': '14',
    'elk.layered.spacing.edgeEdgeBetweenLayers': '12',
    'elk.layered.considerModelOrder.strategy': 'PREFER_NODES',
    'elk.layered.nodePlacement.strategy': 'BRANDES_KOEPF',
    'elk.layered.nodePlacement.bk.fixedAlignment': 'BALANCED',
    'elk.edgeLabels.inline': 'true',
  }
}

function courseOf(node: GraphNode, arrow: ElkArrow, shift: Point): Course | undefined {
  const section = arrow.sections?.[0]
  const start = edgeOf(arrow.id)
  if (!section || !start) return undefined
  const points = [section.startPoint, ...(section.bendPoints ?? []), section.endPoint]
  const label = arrow.labels?.[0]
  return {
    id: arrow.id,
    machine: node.path,
    source: arrow.sources[0] ?? start.source,
    target: arrow.targets[0] ?? '',
    outcome: start.outcome,
    points: points.map((point) => moved(point, shift)),
    label: moved({ x: (label?.x ?? 0) + (label?.width ?? 0) / 2, y: (label?.y ?? 0) + (label?.height ?? 0) / 2 }, shift),
  }
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

/**
 * Where everything of the editor's canvas goes. Pure, apart from the call of the layout engine.
 *
 * A machine is laid out by itself until one of its children has a position of its own; then all its
 * children stay where they were put. Boxes are relative to the frame they stand in, routes to the
 * outermost one; a route that is missing is drawn from port to port by the canvas.
 */
import type { GraphTransition } from '../../api/types'
import { chainOf, layOutChain } from '../chain'
import { flowOf, type Flow } from '../flow'
import { moved, type Box, type Point, type Size } from '../geometry'
import type { LayoutCall } from '../elkGraph'
import { edgeId, outcomeId } from '../edgeId'
import { noteBoxes } from './canvasNotes'
import { adopt, empty, put, sized, type Content } from './content'
import { byEngine, entryOf, portOf, type EngineOptions } from './engineLayout'
import { FRAME_HEAD, frameWidth, leafSize, PILL_HEIGHT, pillsOf, pillWidth, rowsHeight, tableHeight, twigSize } from './measure'
import { isFrame, isMachine, isTreePart, outgoingTransitions, type EditNode } from './model'

export interface ArrangeOptions {
  /** Is the inside of the container at this path shown? */
  readonly isOpen: (path: string) => boolean
  /** Outcomes of a container that nothing leads to yet, by its path. */
  readonly declared: (node: EditNode) => readonly string[]
  /** A chain longer than this goes on in a further row. */
  readonly rowLimit: number
  readonly call: LayoutCall
}

export interface Arrangement {
  readonly size: Size
  readonly boxes: ReadonlyMap<string, Box>
  /** What stands on the canvas itself, not in a frame. */
  readonly outer: ReadonlySet<string>
  readonly routes: ReadonlyMap<string, readonly Point[]>
  /** What to add to the positions of a container's children to get their boxes. */
  readonly origins: ReadonlyMap<string, Point>
}

const PADDING = 16
const GAP = 14
const PILL_GAP = 10
/** Where a row begins. */
const LEFT = 16
/** Room on an arrow, to put something there. */
const ARROW_ROOM = 36
const LEVEL_GAP = 46
const SIBLING_GAP = 22

/** Lay out what is inside `scope`. */
export async function arrange(scope: EditNode, options: ArrangeOptions): Promise<Arrangement> {
  const content = await inside(scope, options, true)
  const { routes, origins } = content
  const table = tableHeight(scope)
  let { width, height } = content
  if (table > 0) {
    width = Math.max(width, 360)
    content.own.set(rulesId(scope.path), { x: 0, y: height + 20, width, height: table })
    height += 20 + table
  }
  for (const [id, box] of noteBoxes(scope, origins.get(scope.path))) content.own.set(id, box)
  return {
    boxes: new Map([...content.deep, ...content.own]),
    outer: new Set(content.own.keys()),
    routes,
    origins,
    size: { width, height },
  }
}

/** The id of the table of rules below a concurrency container that fills the canvas. */
export function rulesId(path: string): string {
  return `${path}#rules`
}

/** One node with all it shows. */
async function unit(node: EditNode, parent: EditNode, options: ArrangeOptions): Promise<Content> {
  if (isTreePart(node.kind) && node.kind !== 'tree') return sized(twigSize(node))
  if (!isFrame(node) || !options.isOpen(node.path)) return sized(leafSize(node, parent))
  const content = await inside(node, { ...options, rowLimit: options.rowLimit - 2 * PADDING }, false)
  const rows = rowsHeight(outgoingTransitions(parent, node).length)
  const table = tableHeight(node)
  const room = takeNotes(node, content)
  const frame = empty(
    Math.max(content.width + room.x + 2 * PADDING, frameWidth(node), table > 0 ? 300 : 0),
    FRAME_HEAD + content.height + room.y + PADDING + table + rows,
  )
  const corner = moved({ x: PADDING, y: FRAME_HEAD }, room)
  adopt(frame, content, corner)
  frame.origins.set(node.path, moved(content.origins.get(node.path) ?? { x: 0, y: 0 }, corner))
  return frame
}

/** Put the notes of a container beside what is in it; gives the room that those left of it and above it need. */
function takeNotes(node: EditNode, content: Content): Point {
  const notes = noteBoxes(node, content.origins.get(node.path))
  for (const [id, box] of notes) {
    content.own.set(id, box)
    content.width = Math.max(content.width, box.x + box.width)
    content.height = Math.max(content.height, box.y + box.height)
  }
  return { x: Math.max(0, ...notes.map(([, box]) => -box.x)), y: Math.max(0, ...notes.map(([, box]) => -box.y)) }
}

async function inside(node: EditNode, options: ArrangeOptions, isScope: boolean): Promise<Content> {
  if (isTreePart(node.kind)) return tree(node, options)
  const units = await Promise.all(node.children.map((child) => unit(child, node, options)))
  if (isMachine(node.kind)) return machine(node, units, options, isScope)
  return regions(node, units)
}

/** Children side by side are stacked, each as wide as the widest. */
function regions(node: EditNode, units: readonly Content[]): Content {
  if (units.length === 0) return empty(220, 60)
  const content = empty()
  const widest = Math.max(...units.map((each) => each.width))
  node.children.forEach((child, index) => {
    const own = units[index]
    if (!own) return
    const isOpen = own.own.size > 0
    const box = { x: 0, y: content.height, width: isOpen ? own.width : widest, height: own.height }
    put(content, child.path, box, own)
    content.height += own.height + GAP
  })
  content.width = widest
  content.height -= GAP
  return content
}

/** The top of a tree is drawn above its children, in their order, which means something. */
async function tree(node: EditNode, options: ArrangeOptions): Promise<Content> {
  const tops = node.kind === 'tree' ? node.children : [node]
  const content = empty()
  for (const top of tops) {
    const branch = await twig(top, node, options)
    adopt(content, branch, { x: content.width, y: 0 })
    content.width += branch.width
    content.height = Math.max(content.height, branch.height)
  }
  return content
}

async function twig(node: EditNode, parent: EditNode, options: ArrangeOptions): Promise<Content> {
  const own = await unit(node, parent, options)
  const content = empty(own.width, own.height)
  const isBranch = isTreePart(node.kind) && node.kind !== 'tree' && options.isOpen(node.path) && node.children.length > 0
  if (!isBranch) {
    put(content, node.path, { x: 0, y: 0, width: own.width, height: own.height }, own)
    return content
  }
  const branches: Content[] = []
  for (const child of node.children) branches.push(await twig(child, node, options))
  const breadth = branches.reduce((sum, each) => sum + each.width, 0) + SIBLING_GAP * (branches.length - 1)
  content.width = Math.max(own.width, breadth)
  let x = (content.width - breadth) / 2
  const centers: number[] = []
  branches.forEach((branch, index) => {
    const child = node.children[index]
    adopt(content, branch, { x, y: own.height + LEVEL_GAP })
    const box = child && content.own.get(child.path)
    centers.push(box ? box.x + box.width / 2 : x)
    content.height = Math.max(content.height, own.height + LEVEL_GAP + branch.height)
    x += branch.width + SIBLING_GAP
  })
  const middle = ((centers[0] ?? 0) + (centers[centers.length - 1] ?? 0)) / 2
  const left = Math.min(Math.max(0, middle - own.width / 2), content.width - own.width)
  put(content, node.path, { x: left, y: 0, width: own.width, height: own.height }, own)
  return content
}

async function machine(node: EditNode, units: readonly Content[], options: ArrangeOptions, isScope: boolean): Promise<Content> {
  const { drawn, gathered } = pillsOf(node, options.declared(node))
  if (node.children.length === 0) return withGathered(node, empty(240, 70), gathered)
  const isManual = node.children.some((child) => child.position !== null)
  const flow = isManual ? placed(node, units, drawn, isScope) : await laidOut(node, units, drawn, options)
  return withGathered(node, flow, gathered)
}

/** Outcomes that several arrows lead to, or none, stand in a line below: those arrows are written at their ports. */
function withGathered(node: EditNode, flow: Content, gathered: readonly string[]): Content {
  if (gathered.length === 0) return flow
  const bottoms = node.children.map((child) => flow.own.get(child.path)).flatMap((box) => (box ? [box.y + box.height] : []))
  const lefts = node.children.map((child) => flow.own.get(child.path)).flatMap((box) => (box ? [box.x] : []))
  const y = Math.max(flow.height, ...bottoms) + 18
  let x = Math.min(...(lefts.length > 0 ? lefts : [0]))
  for (const outcome of gathered) {
    const width = pillWidth(outcome) + 24
    flow.own.set(outcomeId(node.path, outcome), { x, y, width, height: PILL_HEIGHT })
    x += width + PILL_GAP
  }
  flow.width = Math.max(flow.width, x - PILL_GAP)
  flow.height = y + PILL_HEIGHT
  return flow
}

/** Children at the positions they were given; those without one stand below. */
function placed(node: EditNode, units: readonly Content[], drawn: readonly string[], isScope: boolean): Content {
  const content = empty()
  const at = node.children.map((child) => child.position)
  const known = at.flatMap((each) => (each ? [each] : []))
  const left = Math.min(...known.map(([x]) => x))
  const top = Math.min(...known.map(([, y]) => y))
  // In a frame the children stand in its upper left corner; on the open canvas, exactly where they were put.
  const origin = isScope ? { x: 0, y: 0 } : { x: -left, y: -top }
  content.origins.set(node.path, origin)
  node.children.forEach((child, index) => {
    const own = units[index]
    const position = at[index]
    if (own && position)
      put(content, child.path, { x: position[0] + origin.x, y: position[1] + origin.y, width: own.width, height: own.height }, own)
  })
  const below = Math.max(...[...boxesOf(content, node)].map((box) => box.y + box.height)) + 30
  let x = isScope ? left : 0
  node.children.forEach((child, index) => {
    const own = units[index]
    if (!own || at[index]) return
    put(content, child.path, { x, y: below, width: own.width, height: own.height }, own)
    x += own.width + 40
  })
  const right = Math.max(...boxesOf(content, node).map((box) => box.x + box.width))
  let bottom = -Infinity
  for (const outcome of drawn) {
    const source = node.transitions.find((t) => t.target === outcome)?.source
    const child = node.children.find((each) => each.name === source)
    const box = child && content.own.get(child.path)
    const y = Math.max(bottom + PILL_GAP, box ? box.y + box.height - PILL_HEIGHT : 0)
    content.own.set(outcomeId(node.path, outcome), { x: right + 54, y, width: pillWidth(outcome), height: PILL_HEIGHT })
    bottom = y + PILL_HEIGHT
  }
  const all = [...content.own].filter(([id]) => id.startsWith(`${node.path}#`)).map(([, box]) => box)
  const every = [...boxesOf(content, node), ...all]
  content.width = Math.max(...every.map((box) => box.x + box.width))
  content.height = Math.max(...every.map((box) => box.y + box.height))
  return content
}

function boxesOf(content: Content, node: EditNode): readonly Box[] {
  return node.children.flatMap((child) => content.own.get(child.path) ?? [])
}

async function laidOut(node: EditNode, units: readonly Content[], drawn: readonly string[], options: ArrangeOptions): Promise<Content> {
  const shown = node.transitions.filter((t) => drawn.includes(t.target) || node.children.some((child) => child.name === t.target))
  const flow = flowOf(
    node.children.map((child) => child.name),
    shown,
    node.initial,
  )
  return alongFlow(node, units, drawn, { flow, shown }, options)
}

interface Course {
  readonly flow: Flow
  /** The transitions that are drawn. */
  readonly shown: readonly GraphTransition[]
}

async function alongFlow(
  node: EditNode,
  units: readonly Content[],
  drawn: readonly string[],
  { flow, shown }: Course,
  options: EngineOptions,
): Promise<Content> {
  const chain = chainOf(flow, shown, drawn)
  const content = chain
    ? inRows(node, units, [flow.order[0] ?? '', ...chain.map((t) => t.target)], chain, options.rowLimit)
    : await byEngine(node, units, drawn, flow, options)
  standAside(node, units, content, flow.loose, options.rowLimit)
  return content
}

/**
 * Some children of a machine, laid out among themselves in the order that they have in the whole machine; `sizes` are
 * those of the nodes as they are drawn, by path. Their boxes, of which none begins left of or above 0.
 */
export async function arrangeAmong(
  node: EditNode,
  sizes: ReadonlyMap<string, Size>,
  options: EngineOptions,
): Promise<ReadonlyMap<string, Box>> {
  const children = node.children.filter((child) => sizes.has(child.path))
  const names = new Set(children.map((child) => child.name))
  const ofThese = (all: readonly string[]) => all.filter((name) => names.has(name))
  const whole = flowOf(
    node.children.map((child) => child.name),
    node.transitions,
    node.initial,
  )
  const loose = ofThese(whole.loose)
  // Where no transition leads to or from any of them, there is nothing beside which they would stand aside.
  const isLoose = loose.length === children.length
  const flow = isLoose
    ? { order: loose, downwards: loose, loose: [] }
    : { order: ofThese(whole.order), downwards: ofThese(whole.downwards), loose }
  const shown = node.transitions.filter((t) => names.has(t.source) && names.has(t.target))
  const units = children.map((child) => sized(sizes.get(child.path) ?? NO_SIZE))
  const content = await alongFlow({ ...node, children }, units, [], { flow, shown }, options)
  return content.own
}

const NO_SIZE: Size = { width: 0, height: 0 }

/** What nothing leads to or from stands below the others, in rows of its own. */
function standAside(node: EditNode, units: readonly Content[], content: Content, loose: readonly string[], limit: number): void {
  let [x, y] = [LEFT, content.height + PILL_GAP + GAP]
  node.children.forEach((child, index) => {
    const own = units[index]
    if (!own || !loose.includes(child.name)) return
    if (x > LEFT && x + own.width > limit) [x, y] = [LEFT, content.height + GAP]
    put(content, child.path, { x, y, width: own.width, height: own.height }, own)
    content.width = Math.max(content.width, x + own.width)
    content.height = Math.max(content.height, y + own.height)
    x += own.width + ARROW_ROOM
  })
}

type Chain = NonNullable<ReturnType<typeof chainOf>>

function inRows(node: EditNode, units: readonly Content[], names: readonly string[], chain: Chain, limit: number): Content {
  const sizes = new Map(node.children.map((child, index) => [child.name, { node: child, path: child.path, own: units[index] }]))
  const items = names.map((name) => {
    const child = sizes.get(name)
    if (!child?.own) {
      return { id: outcomeId(node.path, name), width: pillWidth(name), height: PILL_HEIGHT, axis: PILL_HEIGHT / 2, own: undefined }
    }
    const { width, height } = child.own
    // A row is in line where the arrows of its nodes are; a container that is open stands as high as a closed one.
    return { id: child.path, width, height, axis: entryOf(node, name, leafSize(child.node, node)), own: child.own }
  })
  const rows = layOutChain(items, chain, () => ARROW_ROOM, limit)
  const content = empty(rows.width, rows.height)
  for (const { id, own } of items) {
    const box = rows.boxes.get(id)
    if (box) put(content, id, box, own ?? empty())
  }
  chain.forEach((arrow, index) => {
    const from = content.own.get(items[index]?.id ?? '')
    const to = content.own.get(items[index + 1]?.id ?? '')
    const source = node.children.find((child) => child.name === arrow.source)
    if (from && to && source) {
      content.routes.set(
        edgeId({ machine: node.path, source: arrow.source, outcome: arrow.outcome }),
        course(from, to, portOf(node, source, arrow.outcome, from), entryOf(node, names[index + 1] ?? '', to), rows.boxes),
      )
    }
  })
  return content
}

/** From a port to the next item: with one bend in a row, around its end to the start of the next one. */
function course(from: Box, to: Box, port: number, entry: number, boxes: ReadonlyMap<string, Box>): readonly Point[] {
  const start = { x: from.x + from.width, y: from.y + port }
  const end = { x: to.x, y: to.y + entry }
  if (to.x > from.x) {
    const bend = (start.x + end.x) / 2
    return start.y === end.y ? [start, end] : [start, { x: bend, y: start.y }, { x: bend, y: end.y }, end]
  }
  const row = [...boxes.values()].filter((box) => box.y < from.y + from.height && box.y + box.height > from.y)
  const between = Math.max(...row.map((box) => box.y + box.height)) + 17
  const right = start.x + 14
  const left = end.x - 16
  return [start, { x: right, y: start.y }, { x: right, y: between }, { x: left, y: between }, { x: left, y: end.y }, end]
}

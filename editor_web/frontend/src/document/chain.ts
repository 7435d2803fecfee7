/** Machines that run straight through are laid out by hand: a row, broken into several where it would be too long. */
import type { GraphTransition } from '../api/types'
import type { Flow } from './flow'
import type { Box, Point } from './geometry'

export interface ChainItem {
  readonly id: string
  readonly width: number
  readonly height: number
  /** From its top to the line that a row has in common, along which its arrows go. */
  readonly axis: number
}

export interface ChainArrow {
  readonly transition: GraphTransition
  readonly points: readonly Point[]
  readonly label: Point
}

export interface ChainLayout {
  readonly width: number
  readonly height: number
  readonly boxes: ReadonlyMap<string, Box>
  readonly arrows: readonly ChainArrow[]
}

const ROW_GAP = 34
const MARGIN = 16
const ARROW_MIN = 40
const LABEL_OFFSET = 9

/**
 * What follows each child of a machine, in the order in which it passes them; undefined when its drawn transitions
 * are more than one line.
 */
export function chainOf(
  { order }: Pick<Flow, 'order'>,
  drawn: readonly GraphTransition[],
  outcomes: readonly string[],
): readonly GraphTransition[] | undefined {
  const bySource = new Map<string, GraphTransition>()
  for (const transition of drawn) {
    if (bySource.has(transition.source)) return undefined
    bySource.set(transition.source, transition)
  }
  const passed = new Set<string>()
  const chain: GraphTransition[] = []
  let name = order[0]
  while (name !== undefined && !outcomes.includes(name)) {
    if (passed.has(name)) return undefined
    passed.add(name)
    const next = bySource.get(name)
    if (next) chain.push(next)
    name = next?.target
  }
  const ended = name !== undefined ? 1 : 0
  return passed.size === order.length && outcomes.length === ended ? chain : undefined
}

/**
 * Lay items out like words in lines: each stands behind the one before, in a further row where its row would be longer
 * than `limit`. So nothing moves that comes before a change, and a taller item moves nothing beside it.
 */
export function layOutChain(
  items: readonly ChainItem[],
  chain: readonly GraphTransition[],
  labelWidth: (outcome: string) => number,
  limit: number,
): ChainLayout {
  const gaps = items.map((_, index) => Math.max(ARROW_MIN, labelWidth(chain[index]?.outcome ?? '') + 22))
  return drawRows(fill(items, gaps, limit), items, gaps, chain)
}

/** The index at which each row starts, when no row may be longer than `limit`. */
function fill(items: readonly ChainItem[], gaps: readonly number[], limit: number): readonly number[] {
  const starts = [0]
  let length = 0
  items.forEach((item, index) => {
    const own = item.width + (gaps[index] ?? 0)
    if (index > 0 && length + own > limit) {
      starts.push(index)
      length = 0
    }
    length += own
  })
  return starts
}

function drawRows(
  starts: readonly number[],
  items: readonly ChainItem[],
  gaps: readonly number[],
  chain: readonly GraphTransition[],
): ChainLayout {
  const boxes = new Map<string, Box>()
  const rowEnds: number[] = []
  let y = 6
  let width = 0
  starts.forEach((start, row) => {
    const end = starts[row + 1] ?? items.length
    const inRow = items.slice(start, end)
    const axis = Math.max(...inRow.map((item) => item.axis))
    const height = axis + Math.max(...inRow.map((item) => item.height - item.axis))
    let x = MARGIN
    inRow.forEach((item, index) => {
      boxes.set(item.id, { x, y: y + axis - item.axis, width: item.width, height: item.height })
      x += item.width + (index < inRow.length - 1 ? (gaps[start + index] ?? 0) : 0)
    })
    width = Math.max(width, x)
    y += height
    rowEnds.push(y)
    y += ROW_GAP
  })
  const arrows = chain.flatMap((transition, index) => {
    const from = portsOf(items[index], boxes)
    const to = portsOf(items[index + 1], boxes)
    if (!from || !to) return []
    const row = starts.findIndex((start, i) => index >= start && index < (starts[i + 1] ?? items.length))
    return [{ transition, ...(starts.includes(index + 1) ? turn(from, to, (rowEnds[row] ?? 0) + ROW_GAP / 2) : straight(from, to)) }]
  })
  return { width: width + MARGIN, height: y - ROW_GAP, boxes, arrows }
}

/** Where arrows come into an item, and where they leave it. */
interface Ports {
  readonly entry: Point
  readonly exit: Point
}

function portsOf(item: ChainItem | undefined, boxes: ReadonlyMap<string, Box>): Ports | undefined {
  const box = item && boxes.get(item.id)
  if (!box) return undefined
  const y = box.y + item.axis
  return { entry: { x: box.x, y }, exit: { x: box.x + box.width, y } }
}

function straight({ exit: start }: Ports, { entry: end }: Ports): { points: readonly Point[]; label: Point } {
  const { y } = start
  return { points: [start, end], label: { x: (start.x + end.x) / 2 - 3, y: y - LABEL_OFFSET } }
}

/** From the end of a row around to the start of the next one, along the line between the two at `between`. */
function turn({ exit: start }: Ports, { entry: end }: Ports, between: number): { points: readonly Point[]; label: Point } {
  const right = start.x + MARGIN - 2
  const left = end.x - MARGIN
  return {
    points: [start, { x: right, y: start.y }, { x: right, y: between }, { x: left, y: between }, { x: left, y: end.y }, end],
    label: { x: (right + left) / 2, y: between },
  }
}

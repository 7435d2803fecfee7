/** Machines that run straight through are laid out by hand: a row, broken into several where it would be too long. */
import type { GraphNode, GraphTransition } from '../api/types'
import type { Box, Point } from './geometry'

export interface ChainItem {
  readonly id: string
  readonly width: number
  readonly height: number
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
 * The children of a machine in the order in which it passes them, and what follows each;
 * undefined when its drawn transitions are more than one line.
 */
export function chainOf(
  machine: GraphNode,
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
  let name = machine.initial ?? machine.children[0]?.name
  while (name !== undefined && !outcomes.includes(name)) {
    if (passed.has(name)) return undefined
    passed.add(name)
    const next = bySource.get(name)
    if (next) chain.push(next)
    name = next?.target
  }
  const ended = name !== undefined ? 1 : 0
  return passed.size === machine.children.length && outcomes.length === ended ? chain : undefined
}

/** Lay items out in rows no longer than `limit` where they can be broken, as few and as even as that allows. */
export function layOutChain(
  items: readonly ChainItem[],
  chain: readonly GraphTransition[],
  labelWidth: (outcome: string) => number,
  limit: number,
): ChainLayout {
  const gaps = items.map((_, index) => Math.max(ARROW_MIN, labelWidth(chain[index]?.outcome ?? '') + 22))
  const rows = fill(items, gaps, limit)
  return drawRows(evened(rows, items, gaps), items, gaps, chain)
}

/** The same number of rows with the longest one as short as it can be. */
function evened(rows: readonly number[], items: readonly ChainItem[], gaps: readonly number[]): readonly number[] {
  const whole = items.reduce((sum, item, index) => sum + item.width + (gaps[index] ?? 0), 0)
  let [low, high] = [0, whole]
  while (high - low > 4) {
    const middle = (low + high) / 2
    if (fill(items, gaps, middle).length <= rows.length) high = middle
    else low = middle
  }
  return rows.length === 1 ? rows : fill(items, gaps, high)
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
  const margin = starts.length > 1 ? MARGIN : 0
  let y = 6
  let width = 0
  starts.forEach((start, row) => {
    const end = starts[row + 1] ?? items.length
    const inRow = items.slice(start, end)
    const height = Math.max(...inRow.map((item) => item.height))
    let x = margin
    inRow.forEach((item, index) => {
      boxes.set(item.id, { x, y: y + (height - item.height) / 2, width: item.width, height: item.height })
      x += item.width + (index < inRow.length - 1 ? (gaps[start + index] ?? 0) : 0)
    })
    width = Math.max(width, x)
    y += height
    rowEnds.push(y)
    y += ROW_GAP
  })
  const arrows = chain.flatMap((transition, index) => {
    const from = boxes.get(items[index]?.id ?? '')
    const to = boxes.get(items[index + 1]?.id ?? '')
    if (!from || !to) return []
    const row = starts.findIndex((start, i) => index >= start && index < (starts[i + 1] ?? items.length))
    return [{ transition, ...(starts.includes(index + 1) ? turn(from, to, (rowEnds[row] ?? 0) + ROW_GAP / 2) : straight(from, to)) }]
  })
  return { width: width + margin, height: y - ROW_GAP, boxes, arrows }
}

function straight(from: Box, to: Box): { points: readonly Point[]; label: Point } {
  const y = from.y + from.height / 2
  const start = { x: from.x + from.width, y }
  const end = { x: to.x, y }
  return { points: [start, end], label: { x: (start.x + end.x) / 2 - 3, y: y - LABEL_OFFSET } }
}

/** From the end of a row around to the start of the next one, along the line between the two at `between`. */
function turn(from: Box, to: Box, between: number): { points: readonly Point[]; label: Point } {
  const start = { x: from.x + from.width, y: from.y + from.height / 2 }
  const end = { x: to.x, y: to.y + to.height / 2 }
  const right = start.x + MARGIN - 2
  const left = end.x - MARGIN
  return {
    points: [start, { x: right, y: start.y }, { x: right, y: between }, { x: left, y: between }, { x: left, y: end.y }, end],
    label: { x: (right + left) / 2, y: between },
  }
}

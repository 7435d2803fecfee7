/** A drawing that goes on and on to the right is broken into rows, like a text into lines; its arrows go around. Pure. */
import type { Box, Point, Size } from './geometry'

/** Where the middle of a label is, and how much room it takes. */
export interface Label extends Point {
  readonly width: number
}

export interface Line {
  readonly id: string
  readonly points: readonly Point[]
  readonly label?: Label
}

export interface Strip<L extends Line> {
  readonly boxes: ReadonlyMap<string, Box>
  readonly lines: readonly L[]
}

/** Room left and right of what is drawn. */
const MARGIN = 16
/** From what stands last in a row to the arrows that go on below, and between those. */
const APART = 9
/** Above and below the arrows between two rows. */
const CLEAR = 13
/** A row is broken so far before what is first in the next one: arrows only go straight there. */
const BEFORE = 6
/** No more than this is left empty between what stands over one another: a line may come from below something tall. */
const EMPTY = 26
/** Half the height of a label. */
const HALF_LABEL = 8

/** Part of a line within one row: where it is cut, it goes on in the row before or behind. */
interface Piece {
  readonly row: number
  readonly points: Point[]
}

/** A line that goes on from row `row` to the next one, at height `y`; `lane` counts those from the lowest one on. */
interface Crossing {
  readonly row: number
  readonly y: number
  lane: number
}

interface Row {
  readonly left: number
  readonly right: number
  readonly height: number
  /** From its top to what is at this height of the drawing. */
  readonly down: (y: number) => number
}

/** Break a drawing where its row would be longer than `limit`; what comes before a change stays where it is. */
export function wrapped<L extends Line>(strip: Strip<L>, limit: number): Strip<L> & Size {
  const cuts = cutsOf([...strip.boxes.values()], limit)
  const rowAt = (x: number) => cuts.filter((cut) => cut <= x).length
  const crossings: Crossing[] = []
  const split = strip.lines.map((line) => splitLine(line, rowAt, crossings))
  const lanes = cuts.map((_, row) => countLanes(crossings.filter((each) => each.row === row)))
  const rows = Array.from({ length: cuts.length + 1 }, (_, row) => {
    const inRow = [...strip.boxes.values()].filter((box) => rowAt(box.x) === row)
    const labels = strip.lines.flatMap(({ label }) => (label && rowAt(label.x) === row ? [aroundLabel(label)] : []))
    const points = split.flatMap(({ pieces }) => pieces.filter((piece) => piece.row === row).flatMap((piece) => piece.points))
    const passing = crossings.filter((each) => each.row === row || each.row + 1 === row)
    const xs = [...[...inRow, ...labels].flatMap(({ x, width }) => [x, x + width]), ...points.map(({ x }) => x)]
    return rowOf(xs, [
      ...[...inRow, ...labels].map(({ y, height }) => ({ from: y, to: y + height })),
      ...[...points, ...passing].map(({ y }) => ({ from: y, to: y })),
    ])
  })
  const left = MARGIN + (cuts.length > 0 ? Math.max(...lanes) * APART : 0)
  const tops = [0]
  rows.slice(0, -1).forEach(({ height }, row) => {
    tops.push((tops[row] ?? 0) + height + 2 * CLEAR + Math.max(0, (lanes[row] ?? 0) - 1) * APART)
  })
  const put = <P extends Point>(point: P, row: number): P => ({
    ...point,
    x: point.x + left - (rows[row]?.left ?? 0),
    y: (tops[row] ?? 0) + (rows[row]?.down(point.y) ?? point.y),
  })
  /** The way of a line around the end of its row to the start of the next one. */
  const around = ({ row, y, lane }: Crossing): readonly Point[] => {
    const right = put({ x: rows[row]?.right ?? 0, y }, row)
    const next = put({ x: 0, y }, row + 1)
    const x = right.x + APART * (lane + 1)
    const between = (tops[row] ?? 0) + (rows[row]?.height ?? 0) + CLEAR + lane * APART
    const start = left - APART * ((lanes[row] ?? 1) - lane)
    return [
      { x, y: right.y },
      { x, y: between },
      { x: start, y: between },
      { x: start, y: next.y },
    ]
  }
  const lines = split.map(({ line, pieces, joints }) => ({
    ...line,
    points: pieces.flatMap((piece, index) => {
      const points = piece.points.map((point) => put(point, piece.row))
      const joint = joints[index]
      if (!joint) return points
      return [...points, ...(joint.row === piece.row ? around(joint) : around(joint).toReversed())]
    }),
    ...(line.label ? { label: put(line.label, rowAt(line.label.x)) } : {}),
  }))
  const ends = rows.map((row, index) => left + row.right - row.left + (lanes[index] ?? 0) * APART)
  return {
    boxes: new Map([...strip.boxes].map(([id, box]) => [id, put(box, rowAt(box.x))])),
    lines,
    width: Math.max(...ends) + MARGIN,
    height: (tops.at(-1) ?? 0) + (rows.at(-1)?.height ?? 0),
  }
}

/** Where the rows are broken: before a column, which is what stands over one another, that would make its row too long. */
function cutsOf(boxes: readonly Box[], limit: number): readonly number[] {
  const columns: { left: number; right: number }[] = []
  for (const { x, width } of boxes.toSorted((a, b) => a.x - b.x)) {
    const last = columns.at(-1)
    if (last && x < last.right) last.right = Math.max(last.right, x + width)
    else columns.push({ left: x, right: x + width })
  }
  const cuts: number[] = []
  let start = columns[0]?.left ?? 0
  for (const { left, right } of columns) {
    if (left === start || right - start <= limit) continue
    cuts.push(left - BEFORE)
    start = left
  }
  return cuts
}

function splitLine<L extends Line>(line: L, rowAt: (x: number) => number, crossings: Crossing[]) {
  const pieces: Piece[] = []
  const joints: Crossing[] = []
  for (const point of line.points) {
    const row = rowAt(point.x)
    let piece = pieces.at(-1)
    for (let at = piece?.row ?? row; piece && at !== row;) {
      const step = row > at ? 1 : -1
      const crossing = { row: Math.min(at, at + step), y: point.y, lane: 0 }
      crossings.push(crossing)
      joints.push(crossing)
      at += step
      if (at !== row) pieces.push((piece = { row: at, points: [] }))
    }
    if (piece?.row === row) piece.points.push(point)
    else pieces.push({ row, points: [point] })
  }
  return { line, pieces, joints }
}

/** The lowest line goes around innermost: so none crosses another. */
function countLanes(crossings: readonly Crossing[]): number {
  crossings.toSorted((a, b) => b.y - a.y).forEach((crossing, lane) => (crossing.lane = lane))
  return crossings.length
}

function aroundLabel({ x, y, width }: Label): Box {
  return { x: x - width / 2, y: y - HALF_LABEL, width, height: 2 * HALF_LABEL }
}

interface Span {
  readonly from: number
  readonly to: number
}

/** `taken` is what is at each height: what is empty between is made no larger than it need be. */
function rowOf(xs: readonly number[], taken: readonly Span[]): Row {
  const spans: { from: number; to: number; at: number }[] = []
  for (const { from, to } of taken.toSorted((a, b) => a.from - b.from)) {
    const last = spans.at(-1)
    if (last && from <= last.to) last.to = Math.max(last.to, to)
    else spans.push({ from, to, at: last ? last.at + last.to - last.from + Math.min(EMPTY, from - last.to) : 0 })
  }
  const last = spans.at(-1)
  return {
    left: xs.length > 0 ? Math.min(...xs) : 0,
    right: xs.length > 0 ? Math.max(...xs) : 0,
    height: last ? last.at + last.to - last.from : 0,
    down: (y) => {
      const span = spans.findLast(({ from }) => from <= y) ?? spans[0]
      return span ? span.at + y - span.from : 0
    },
  }
}

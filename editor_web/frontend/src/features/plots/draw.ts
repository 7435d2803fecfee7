/** Draws curves over time: a lane for each unit, all over the same time axis. */
import { agoText, marksOf, rangeAround } from '../../document/axis'
import type { Curves } from '../../document/curves'
import { ticks } from '../../document/timeline'
import { numeral } from '../../document/values'

export interface Curve {
  /** `topic:path`. */
  readonly id: string
  readonly unit: string
  /** Which of the colours. */
  readonly color: number
}

export interface View {
  readonly endS: number
  readonly spanS: number
  /** The time that is pointed at. */
  readonly atS: number | undefined
  /** Times are those of a recorded run, which has no gaps; else they are told as so long ago. */
  readonly isRecorded?: boolean
  /** Where the axis of time begins, from the left edge. */
  readonly leftPx?: number
}

export interface Look {
  readonly text: string
  readonly line: string
  readonly colors: readonly string[]
  readonly font: string
}

export const LEFT_PX = 58
export const RIGHT_PX = 10
const TOP_PX = 6
const FOOT_PX = 20
const LANE_GAP_PX = 10
/** Longer than this without a sample is a gap. */
const GAP_S = 0.6

interface Area {
  readonly left: number
  readonly right: number
  readonly top: number
  readonly bottom: number
}

/** Draw everything anew; sizes are in CSS pixels. */
export function draw(
  pen: CanvasRenderingContext2D,
  size: { width: number; height: number },
  curves: Curves,
  shown: readonly Curve[],
  view: View,
  look: Look,
): void {
  pen.clearRect(0, 0, size.width, size.height)
  pen.font = look.font
  const units = [...new Set(shown.map((curve) => curve.unit))]
  const inner = size.height - TOP_PX - FOOT_PX - LANE_GAP_PX * (units.length - 1)
  units.forEach((unit, index) => {
    const height = inner / units.length
    const top = TOP_PX + index * (height + LANE_GAP_PX)
    const area = { left: view.leftPx ?? LEFT_PX, right: size.width - RIGHT_PX, top, bottom: top + height }
    lane(
      pen,
      area,
      curves,
      shown.filter((curve) => curve.unit === unit),
      unit,
      view,
      look,
    )
  })
  const all = { left: view.leftPx ?? LEFT_PX, right: size.width - RIGHT_PX, top: TOP_PX, bottom: size.height - FOOT_PX }
  timeAxis(pen, all, view, look)
  if (view.atS !== undefined) cursor(pen, all, view.atS, view, look)
}

function lane(
  pen: CanvasRenderingContext2D,
  area: Area,
  curves: Curves,
  shown: readonly Curve[],
  unit: string,
  view: View,
  look: Look,
): void {
  const first = Math.max(0, curves.rowAt(view.endS - view.spanS) - 1)
  const last = Math.min(curves.length - 1, curves.rowAt(view.endS))
  const [low, high] = rangeOf(curves, shown, first, last)
  const y = (value: number) => area.bottom - ((value - low) / (high - low)) * (area.bottom - area.top)
  pen.lineWidth = 1
  pen.strokeStyle = look.line
  pen.fillStyle = look.text
  pen.textAlign = 'right'
  pen.textBaseline = 'middle'
  const marks = marksOf(low, high, Math.max(1, Math.floor((area.bottom - area.top) / 24)))
  for (const mark of marks) {
    pen.beginPath()
    pen.moveTo(area.left, Math.round(y(mark)) + 0.5)
    pen.lineTo(area.right, Math.round(y(mark)) + 0.5)
    pen.stroke()
    pen.fillText(numeral(mark), area.left - 6, y(mark))
  }
  if (unit) {
    pen.textAlign = 'left'
    pen.textBaseline = 'top'
    pen.fillText(unit, area.left + 4, area.top + 1)
  }
  pen.save()
  pen.beginPath()
  pen.rect(area.left, area.top - 1, area.right - area.left, area.bottom - area.top + 2)
  pen.clip()
  pen.lineWidth = 1.6
  pen.lineJoin = 'round'
  for (const curve of shown) {
    pen.strokeStyle = look.colors[curve.color % look.colors.length] ?? look.text
    pen.setLineDash(curve.color >= look.colors.length ? [5, 3] : [])
    line(pen, curves, curve.id, [first, last], view.isRecorded ? Infinity : GAP_S, (at) => xOf(at, area, view), y)
  }
  pen.restore()
}

function line(
  pen: CanvasRenderingContext2D,
  curves: Curves,
  id: string,
  [first, last]: readonly [number, number],
  gapS: number,
  x: (at: number) => number,
  y: (value: number) => number,
): void {
  pen.beginPath()
  let before: number | undefined
  for (let row = first; row <= last; row += 1) {
    const value = curves.value(id, row)
    const at = curves.time(row)
    if (Number.isNaN(value)) {
      before = undefined
      continue
    }
    if (before === undefined || at - before > gapS) pen.moveTo(x(at), y(value))
    else pen.lineTo(x(at), y(value))
    before = at
  }
  pen.stroke()
}

function rangeOf(curves: Curves, shown: readonly Curve[], first: number, last: number): readonly [number, number] {
  let low = Infinity
  let high = -Infinity
  for (const curve of shown) {
    for (let row = first; row <= last; row += 1) {
      const value = curves.value(curve.id, row)
      if (value < low) low = value
      if (value > high) high = value
    }
  }
  return rangeAround(low, high)
}

function timeAxis(pen: CanvasRenderingContext2D, area: Area, view: View, look: Look): void {
  pen.fillStyle = look.text
  pen.strokeStyle = look.line
  pen.lineWidth = 1
  pen.textBaseline = 'top'
  for (const { timeS, label, isLast } of timeMarks(area, view)) {
    const x = Math.round(xOf(timeS, area, view)) + 0.5
    pen.beginPath()
    pen.moveTo(x, area.bottom)
    pen.lineTo(x, area.bottom + 4)
    pen.stroke()
    pen.textAlign = isLast ? 'right' : 'center'
    pen.fillText(label, x, area.bottom + 6)
  }
  pen.beginPath()
  pen.moveTo(area.left, area.bottom + 0.5)
  pen.lineTo(area.right, area.bottom + 0.5)
  pen.stroke()
}

function timeMarks(area: Area, view: View): readonly { readonly timeS: number; readonly label: string; readonly isLast: boolean }[] {
  const width = area.right - area.left
  if (view.isRecorded) {
    const shown = { fromS: view.endS - view.spanS, untilS: view.endS }
    return ticks(shown, width).map(({ timeS, label }) => ({
      timeS,
      label,
      isLast: width - xOf(timeS, { left: 0, right: width }, view) < 20,
    }))
  }
  return marksOf(0, view.spanS, Math.max(2, Math.floor(width / 90))).map((ago) => ({
    timeS: view.endS - ago,
    label: agoText(ago),
    isLast: ago === 0,
  }))
}

function cursor(pen: CanvasRenderingContext2D, area: Area, atS: number, view: View, look: Look): void {
  const x = Math.round(xOf(atS, area, view)) + 0.5
  pen.strokeStyle = look.text
  pen.setLineDash([3, 3])
  pen.beginPath()
  pen.moveTo(x, area.top)
  pen.lineTo(x, area.bottom)
  pen.stroke()
  pen.setLineDash([])
}

function xOf(at: number, area: { left: number; right: number }, view: View): number {
  return area.right - ((view.endS - at) / view.spanS) * (area.right - area.left)
}

/** The time at a place of the canvas. */
export function timeAt(x: number, width: number, view: Pick<View, 'endS' | 'spanS' | 'leftPx'>): number {
  const right = width - RIGHT_PX
  return view.endS - ((right - x) / (right - (view.leftPx ?? LEFT_PX))) * view.spanS
}

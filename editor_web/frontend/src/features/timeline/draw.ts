/** Draws the ruler, the marks and the bars of a timeline; only what is in sight. */
import type { ActivationInterval, TimelineMarker } from '../../api/types'
import { ticks, xOf, type MarkKind, type ShownRow, type View } from '../../document/timeline'
import { tokensOf } from '../../components/tokens'

export const ROW = 22
export const HEAD = 38
const RULER = 19
const BAR = 14
const LEAST = 2

export interface Colors {
  readonly text: string
  readonly quiet: string
  readonly line: string
  readonly ground: string
  readonly surface: string
  readonly accent: string
  readonly accentSoft: string
  readonly status: Readonly<Record<string, readonly [edge: string, fill: string]>>
  readonly mark: Readonly<Record<MarkKind, string>>
}

/** The page's colours as they are in the present scheme. */
export function colorsOf(element: Element): Colors {
  const of = tokensOf(element)
  const status = Object.fromEntries(['active', 'done', 'failed', 'stopped'].map((each) => [each, [of(each), of(`${each}-soft`)] as const]))
  return {
    text: of('text'),
    quiet: of('quiet'),
    line: of('line'),
    ground: of('ground'),
    surface: of('surface'),
    accent: of('accent'),
    accentSoft: of('accent-soft'),
    status,
    mark: {
      failure: of('failed'),
      warning: of('stopped'),
      fault: of('failed'),
      command: of('accent'),
      gate: of('stopped'),
      change: of('done'),
      goal: of('line-strong'),
      contact: of('active'),
      grasp: of('done'),
      force: of('stopped'),
      limit: of('failed'),
    },
  }
}

/** Make the canvas as fine as the screen; its context, in pixels of the page. */
export function cleared(canvas: HTMLCanvasElement, width: number, height: number): CanvasRenderingContext2D | undefined {
  const scale = devicePixelRatio || 1
  const [wide, high] = [Math.round(width * scale), Math.round(height * scale)]
  if (canvas.width !== wide) canvas.width = wide
  if (canvas.height !== high) canvas.height = high
  const context = canvas.getContext('2d') ?? undefined
  context?.setTransform(scale, 0, 0, scale, 0, 0)
  context?.clearRect(0, 0, width, height)
  return context
}

/** The times, and below them the marks. */
export function drawHead(
  on: CanvasRenderingContext2D,
  view: View,
  width: number,
  marks: readonly TimelineMarker[],
  colors: Colors,
  font: string,
): void {
  on.font = `11px ${font}`
  on.textBaseline = 'middle'
  for (const tick of ticks(view, width)) {
    const x = xOf(view, width, tick.timeS)
    on.fillStyle = colors.line
    on.fillRect(x, RULER - 6, 1, 6)
    on.fillStyle = colors.quiet
    on.fillText(tick.label, x + 4, RULER / 2)
  }
  on.fillStyle = colors.line
  on.fillRect(0, RULER, width, 1)
  // Failures come last, on top of all others that stand in the same place.
  let beforeX = -9
  for (const mark of marks) {
    if (mark.kind !== 'goal') continue
    const x = Math.round(xOf(view, width, mark.time_s))
    if (x < -5 || x > width + 5 || x === beforeX) continue
    beforeX = x
    on.fillStyle = colors.mark.goal
    on.fillRect(x, RULER + 5, 1.5, 8)
  }
  for (const isFailure of [false, true]) {
    for (const mark of marks) {
      if (mark.kind === 'goal' || (mark.kind === 'failure') !== isFailure) continue
      const x = xOf(view, width, mark.time_s)
      // One at the very beginning or end is not cut in two.
      if (x >= -6 && x <= width + 6) drawMark(on, mark.kind as MarkKind, Math.min(Math.max(x, 5), width - 5), RULER + 9, colors)
    }
  }
}

/** Each kind has a shape of its own, for those who do not see the colour. */
export function drawMark(on: CanvasRenderingContext2D, kind: MarkKind, x: number, y: number, colors: Colors): void {
  on.fillStyle = colors.mark[kind]
  on.strokeStyle = colors.mark[kind]
  on.lineWidth = 2
  on.beginPath()
  switch (kind) {
    case 'failure':
      on.moveTo(x - 4, y - 4)
      on.lineTo(x + 4, y + 4)
      on.moveTo(x + 4, y - 4)
      on.lineTo(x - 4, y + 4)
      on.stroke()
      return
    case 'warning':
    case 'fault':
      on.moveTo(x, y - 5)
      on.lineTo(x + 5, y + 4)
      on.lineTo(x - 5, y + 4)
      break
    case 'command':
      on.rect(x - 4, y - 4, 8, 8)
      break
    case 'contact':
      on.arc(x, y, 4.5, 0, 2 * Math.PI)
      break
    case 'grasp':
      // Two fingers, open at the bottom.
      on.moveTo(x - 4, y + 5)
      on.lineTo(x - 4, y - 4)
      on.lineTo(x + 4, y - 4)
      on.lineTo(x + 4, y + 5)
      on.stroke()
      return
    case 'force':
      on.moveTo(x, y - 5)
      on.lineTo(x + 5, y)
      on.lineTo(x + 2, y)
      on.lineTo(x + 2, y + 5)
      on.lineTo(x - 2, y + 5)
      on.lineTo(x - 2, y)
      on.lineTo(x - 5, y)
      break
    case 'limit':
      // Against a wall.
      on.rect(x + 2, y - 5, 2.5, 10)
      on.rect(x - 5, y - 1.5, 7, 3)
      break
    case 'gate':
      on.rect(x - 4, y - 5, 3, 10)
      on.rect(x + 1, y - 5, 3, 10)
      break
    default:
      on.moveTo(x, y - 5)
      on.lineTo(x + 5, y)
      on.lineTo(x, y + 5)
      on.lineTo(x - 5, y)
  }
  on.closePath()
  on.fill()
}

export interface Bars {
  readonly rows: readonly ShownRow[]
  readonly spans: ReadonlyMap<string, readonly ActivationInterval[]>
  readonly selected: string | undefined
  readonly nowS: number
  /** How far the rows are scrolled. */
  readonly topPx: number
}

export function drawBars(
  on: CanvasRenderingContext2D,
  view: View,
  width: number,
  height: number,
  bars: Bars,
  colors: Colors,
  font: string,
): void {
  const first = Math.max(0, Math.floor(bars.topPx / ROW))
  const last = Math.min(bars.rows.length, Math.ceil((bars.topPx + height) / ROW))
  on.fillStyle = colors.line
  on.globalAlpha = 0.55
  for (const tick of ticks(view, width)) on.fillRect(Math.round(xOf(view, width, tick.timeS)), 0, 1, height)
  on.globalAlpha = 1
  on.font = `10.5px ${font}`
  on.textBaseline = 'middle'
  for (let index = first; index < last; index += 1) {
    const row = bars.rows[index]
    if (!row) continue
    const y = index * ROW - bars.topPx
    if (row.path === bars.selected) {
      on.fillStyle = colors.accentSoft
      on.fillRect(0, y, width, ROW)
    }
    drawRow(on, view, width, bars.spans.get(row.path) ?? [], y + (ROW - BAR) / 2, bars.nowS, colors, row.hasChildren)
  }
}

function drawRow(
  on: CanvasRenderingContext2D,
  view: View,
  width: number,
  spans: readonly ActivationInterval[],
  y: number,
  nowS: number,
  colors: Colors,
  isContainer: boolean,
): void {
  let endX = -Infinity
  for (let index = firstVisible(spans, view); index < spans.length; index += 1) {
    const span = spans[index]
    if (!span || span.start_s > view.untilS) return
    const x = Math.max(xOf(view, width, span.start_s), -2)
    const right = Math.min(xOf(view, width, span.end_s ?? nowS), width + 2)
    // What no pixel is left for is under the bar before; what went wrong is always drawn.
    if (right < endX && span.status === 'done') continue
    const long = Math.max(right - x, LEAST)
    endX = x + long
    const [edge, fill] = colors.status[span.status] ?? [colors.quiet, colors.ground]
    on.fillStyle = long > 5 ? fill : edge
    on.fillRect(x, y, long, BAR)
    if (long <= 5) continue
    on.fillStyle = edge
    on.fillRect(x, y, span.status === 'failed' ? 5 : 2.5, BAR)
    on.fillRect(x, y + BAR - (isContainer ? 3 : 1), long, isContainer ? 3 : 1)
    const label = span.count > 1 ? `${span.count} ×` : span.outcome
    if (label && long > 30) writeInside(on, label, x + 7, y, long - 10, colors)
  }
}

function writeInside(on: CanvasRenderingContext2D, label: string, x: number, y: number, room: number, colors: Colors): void {
  if (on.measureText(label).width > room) return
  on.fillStyle = colors.text
  on.fillText(label, x, y + BAR / 2 + 0.5)
}

/** The first span that does not end before what is seen. */
function firstVisible(spans: readonly ActivationInterval[], view: View): number {
  let [low, high] = [0, spans.length]
  while (low < high) {
    const middle = (low + high) >> 1
    const end = spans[middle]?.end_s
    if (end !== null && end !== undefined && end < view.fromS) low = middle + 1
    else high = middle
  }
  return low
}

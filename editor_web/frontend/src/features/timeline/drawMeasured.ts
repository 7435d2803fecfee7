/** Draws what was measured into the lanes of the nodes that it happened in: a mark, and words where there is room. */
import { laneWords, rowOf, type Mark } from '../../document/measured'
import { xOf, type MarkKind, type ShownRow, type View } from '../../document/timeline'
import { drawMark, ROW, type Colors } from './draw'
import { kindWord } from './words'

const WORDS_PX = 8
const EDGE_PX = 5

export interface MeasuredLanes {
  readonly rows: readonly ShownRow[]
  readonly marks: readonly Mark[]
  readonly topPx: number
}

export function drawMeasured(
  on: CanvasRenderingContext2D,
  view: View,
  size: { readonly width: number; readonly height: number },
  { rows, marks, topPx }: MeasuredLanes,
  colors: Colors,
  font: string,
): void {
  on.font = `600 10.5px ${font}`
  on.textBaseline = 'middle'
  // From the last one on, each knows how much room is left up to the next one in its lane.
  const nextX = new Map<number, number>()
  for (const mark of marks.toReversed()) {
    if (!mark.measured || !mark.path) continue
    const row = rowOf(rows, mark.path)
    const y = row * ROW - topPx + ROW / 2
    const place = xOf(view, size.width, mark.time_s)
    if (row < 0 || y < -ROW || y > size.height + ROW || place < -EDGE_PX || place > size.width + EDGE_PX) continue
    const x = Math.min(Math.max(place, EDGE_PX), size.width - EDGE_PX)
    const words = laneWords(kindWord(mark.kind), mark.measured)
    const wide = on.measureText(words).width
    if (x + WORDS_PX + wide + 3 < (nextX.get(row) ?? size.width)) {
      on.fillStyle = colors.surface
      on.fillRect(x + WORDS_PX - 2, y - 8, wide + 4, 16)
      on.fillStyle = colors.text
      on.fillText(words, x + WORDS_PX, y + 0.5)
    }
    on.fillStyle = colors.surface
    on.fillRect(x - 7, y - 8, 14, 16)
    drawMark(on, mark.kind as MarkKind, x, y, colors)
    nextX.set(row, x - 8)
  }
}

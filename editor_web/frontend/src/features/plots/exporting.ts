/** Saving what is plotted as a file. */
import { saveBlob } from '../../components/saveBlob'
import { tokensOf } from '../../components/tokens'
import type { Dict } from '../../document/dict'
import type { LegendEntry } from './Legend'

/** What the columns of a file are called: topic, field and unit. */
export function headingsOf(entries: readonly LegendEntry[]): Dict<string> {
  return Object.fromEntries(entries.map(({ id, topic, label, unit }) => [id, `${topic} ${label}${unit && ` (${unit})`}`]))
}

const LINE_PX = 18
const MARGIN_PX = 10

/** The picture of a canvas, with the names of its curves below it, on the ground that it has on the page. */
export function savePicture(canvas: HTMLCanvasElement, entries: readonly LegendEntry[], name: string): void {
  const scale = canvas.clientWidth > 0 ? canvas.width / canvas.clientWidth : 1
  const copy = document.createElement('canvas')
  copy.width = canvas.width
  copy.height = canvas.height + Math.round((entries.length * LINE_PX + MARGIN_PX) * scale)
  const pen = copy.getContext('2d')
  if (!pen) return
  const style = getComputedStyle(canvas)
  const token = tokensOf(canvas)
  pen.fillStyle = token('surface')
  pen.fillRect(0, 0, copy.width, copy.height)
  pen.drawImage(canvas, 0, 0)
  pen.setTransform(scale, 0, 0, scale, 0, canvas.height)
  pen.font = `12px ${style.fontFamily}`
  pen.textBaseline = 'middle'
  pen.lineWidth = 3
  entries.forEach(({ topic, label, unit, color }, index) => {
    const y = index * LINE_PX + LINE_PX / 2
    pen.strokeStyle = token(`curve-${color % 8}`)
    pen.setLineDash(color >= 8 ? [5, 3] : [])
    pen.beginPath()
    pen.moveTo(MARGIN_PX, y)
    pen.lineTo(MARGIN_PX + 18, y)
    pen.stroke()
    pen.fillStyle = token('text')
    pen.fillText(`${topic} ${label}${unit && ` (${unit})`}`, MARGIN_PX + 26, y)
  })
  copy.toBlob((blob) => blob && saveBlob(blob, name), 'image/png')
}

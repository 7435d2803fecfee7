/** Saving what is plotted as a file. */
import { tokensOf } from '../../components/tokens'

export function saveBlob(blob: Blob, name: string): void {
  const link = document.createElement('a')
  link.href = URL.createObjectURL(blob)
  link.download = name
  link.click()
  URL.revokeObjectURL(link.href)
}

/** The picture of a canvas on the ground that it has on the page: a canvas itself has none. */
export function savePicture(canvas: HTMLCanvasElement, name: string): void {
  const copy = document.createElement('canvas')
  copy.width = canvas.width
  copy.height = canvas.height
  const pen = copy.getContext('2d')
  if (!pen) return
  pen.fillStyle = tokensOf(canvas)('surface')
  pen.fillRect(0, 0, copy.width, copy.height)
  pen.drawImage(canvas, 0, 0)
  copy.toBlob((blob) => blob && saveBlob(blob, name), 'image/png')
}

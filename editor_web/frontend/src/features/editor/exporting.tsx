/** The whole behavior as a picture file, in the colours of the page: SVG, PNG at twice the size, or PDF, which the server makes of the SVG. */
import { createRoot } from 'react-dom/client'
import { flushSync } from 'react-dom'
import { expansionOf, rowLimitOf } from '../../document/editing/expansion'
import { fileTitle } from '../../document/path'
import { wordsOf } from '../../api/client'
import { documents } from '../../api/documents'
import { layOutByElk } from '../../components/elk'
import { saveBlob } from '../../components/saveBlob'
import { tokensOf } from '../../components/tokens'
import { drawingOf } from './drawing'
import { Picture } from './Picture'
import { paletteOf } from './pictureParts'
import { draftOf, editor, showEditorRefusal, rootOf, showEditorNotice } from './store'

const SCALE = 2
/** No browser draws more on one canvas than so many pixels a side. */
const LARGEST_PX = 8192

export type PictureFormat = 'svg' | 'png' | 'pdf'

export async function exportPicture(format: PictureFormat): Promise<void> {
  try {
    const { id } = editor()
    const svg = await pictureOfDraft()
    const name = `${fileTitle(id)}.${format}`
    if (format === 'svg') saveBlob(new Blob([svg], { type: 'image/svg+xml' }), name)
    else saveBlob(await (format === 'png' ? pngOf(svg) : documents.pdf(id, svg)), name)
    showEditorNotice(`Exported ${name}`)
  } catch (error) {
    showEditorRefusal('Export', wordsOf(error))
  }
}

/** The SVG of the present draft, with containers as they are opened by hand. */
async function pictureOfDraft(): Promise<string> {
  const state = editor()
  const root = rootOf(state)
  if (!root) throw new Error('there is nothing to draw yet')
  const { document: info } = draftOf(state)
  const isOpen = expansionOf(root, state.opened, state.keptOpen)
  const drawn = await drawingOf(root, info?.outcomes ?? [], isOpen, rowLimitOf(root, isOpen), layOutByElk)
  const host = document.createElement('div')
  const page = createRoot(host)
  flushSync(() =>
    page.render(<Picture drawn={drawn} title={info?.name || state.id} palette={paletteOf(tokensOf(document.documentElement))} />),
  )
  const element = host.querySelector('svg')
  if (!element) throw new Error('the behavior could not be drawn')
  const text = new XMLSerializer().serializeToString(element)
  page.unmount()
  return `<?xml version="1.0" encoding="UTF-8"?>\n${text}\n`
}

async function pngOf(svg: string): Promise<Blob> {
  const image = new Image()
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`
  await image.decode()
  const scale = Math.min(SCALE, LARGEST_PX / Math.max(image.width, image.height))
  const canvas = document.createElement('canvas')
  canvas.width = Math.ceil(image.width * scale)
  canvas.height = Math.ceil(image.height * scale)
  const context = canvas.getContext('2d')
  if (!context) throw new Error('this browser draws no pictures')
  context.drawImage(image, 0, 0, canvas.width, canvas.height)
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the picture is too large'))), 'image/png'),
  )
}

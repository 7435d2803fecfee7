/** Draws a whole behavior as an SVG without a browser: the program that `flexcell picture` runs in a JavaScript engine. */
// First: the others find what it puts there.
import { supplied } from './bareEngine'
import Elk from 'elkjs/lib/elk.bundled.js'
import { renderToStaticMarkup } from 'react-dom/server'
import type { DocumentInfo, DocumentNode } from '../api/types'
import { schemeTokens } from '../components/tokens'
import type { LayoutCall } from '../document/elkGraph'
import { allNodes } from '../document/editing/model'
import { drawingOf, openWith } from '../features/editor/drawing'
import { rowLimitOf } from '../document/editing/expansion'
import { Picture } from '../features/editor/Picture'
import { paletteOf } from '../features/editor/pictureParts'
import tokens from './styles/tokens.css?raw'

export interface PictureRequest {
  readonly graph: DocumentNode
  readonly document: DocumentInfo
  readonly scheme: 'light' | 'dark'
  /** All containers show their inside, not only those that are open by themselves on the canvas. */
  readonly all: boolean
}

/** The SVG of a behavior, the same that the page exports. */
export async function pictureFile(request: PictureRequest): Promise<string> {
  try {
    return await draw(request)
  } catch (error) {
    throw new Error(`${String(error)}; this engine lacked ${supplied.join(', ') || 'nothing'}`, { cause: error })
  }
}

async function draw({ graph, document, scheme, all }: PictureRequest): Promise<string> {
  const elk = new Elk()
  const call: LayoutCall = async (shape) => (await elk.layout(shape as Parameters<typeof elk.layout>[0])) as typeof shape
  const inside = new Set(allNodes(graph).map((node) => node.path))
  const isOpen = all ? (path: string) => inside.has(path) : openWith(graph)
  const drawn = await drawingOf(graph, document.outcomes, isOpen, rowLimitOf(graph, isOpen), call)
  const palette = paletteOf(schemeTokens(tokens, scheme))
  return `<?xml version="1.0" encoding="UTF-8"?>\n${renderToStaticMarkup(<Picture drawn={drawn} title={document.name} palette={palette} />)}\n`
}

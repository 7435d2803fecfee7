/** Draws a whole behavior as an SVG without a browser: the program that `flexcell picture` runs in a JavaScript engine. */
// First: the others find what it puts there.
import { supplied } from './bareEngine'
import Elk from 'elkjs/lib/elk.bundled.js'
import { renderToStaticMarkup } from 'react-dom/server'
import type { DocumentInfo, DocumentNode } from '../api/types'
import { schemeTokens } from '../components/tokens'
import type { LayoutCall } from '../document/elkGraph'
import { depthOf, pathsTo } from '../document/path'
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
  /** Instead of those that are open by themselves, the containers of so many levels. */
  readonly depth: number | null
  /** Containers that are open too, with those around them. */
  readonly open: readonly string[]
}

/** The SVG of a behavior, the same that the page exports. */
export async function pictureFile(request: PictureRequest): Promise<string> {
  try {
    return await draw(request)
  } catch (error) {
    throw new Error(`${String(error)}; this engine lacked ${supplied.join(', ') || 'nothing'}`, { cause: error })
  }
}

async function draw({ graph, document, scheme, ...opened }: PictureRequest): Promise<string> {
  const elk = new Elk()
  const call: LayoutCall = async (shape) => (await elk.layout(shape as Parameters<typeof elk.layout>[0])) as typeof shape
  const isOpen = openingOf(graph, opened)
  const drawn = await drawingOf(graph, document.outcomes, isOpen, rowLimitOf(graph, isOpen), call)
  const palette = paletteOf(schemeTokens(tokens, scheme))
  return `<?xml version="1.0" encoding="UTF-8"?>\n${renderToStaticMarkup(<Picture drawn={drawn} title={document.name} palette={palette} />)}\n`
}

/** Which containers of a behavior show their inside. */
function openingOf(graph: DocumentNode, { all, depth, open }: Pick<PictureRequest, 'all' | 'depth' | 'open'>): (path: string) => boolean {
  const byItself = openWith(graph)
  const asked = new Set(open.flatMap((path) => pathsTo(path)))
  return (path) => all || asked.has(path) || (depth === null ? byItself(path) : depthOf(path) <= depth)
}

/** The program of `flexcell picture` draws what the page exports. */
import { createRoot } from 'react-dom/client'
import { flushSync } from 'react-dom'
import { expect, it } from 'vitest'
import { node, machineNode } from '../document/editing/testNodes'
import type { DocumentInfo, DocumentNode } from '../api/types'
import { drawingOf, openWith } from '../features/editor/drawing'
import { Picture } from '../features/editor/Picture'
import { paletteOf } from '../features/editor/pictureParts'
import { rowLimitOf } from '../document/editing/expansion'
import { schemeTokens } from '../components/tokens'
import { pictureFile } from './pictureFile'
import tokens from './styles/tokens.css?raw'

const INFO = {
  name: 'shift <1>',
  description: '',
  cell: null,
  parameters: {},
  userdata: {},
  outcomes: ['good'],
  success: [],
} as DocumentInfo
const NOTHING = { all: false, depth: null, open: [] }
const CHAIN = [
  ['a', 'done', 'b'],
  ['b', 'done', 'good'],
] as const
const GRAPH: DocumentNode = {
  ...machineNode('root', 'a', [node('root/a', ['done']), node('root/b', ['done'])], CHAIN),
  canvas_notes: { n1: { text: 'Mind the gap', position: [0, 200], size: [200, 90], colour: 'green' } },
}
const BRANCHING = machineNode(
  'root',
  'a',
  [node('root/a', ['x', 'y']), node('root/b', ['done']), node('root/c', ['done'])],
  [
    ['a', 'x', 'b'],
    ['a', 'y', 'c'],
    ['b', 'done', 'good'],
    ['c', 'done', 'good'],
  ],
)

it('is the drawing of the page, in the colours of the scheme', async () => {
  const call = () => Promise.reject(new Error('the engine was called'))
  const isOpen = openWith(GRAPH)
  const drawn = await drawingOf(GRAPH, INFO.outcomes, isOpen, rowLimitOf(GRAPH, isOpen), call)
  const host = document.createElement('div')
  const palette = paletteOf(schemeTokens(tokens, 'dark'))
  flushSync(() => createRoot(host).render(<Picture drawn={drawn} title={INFO.name} palette={palette} />))
  const made = document.createElement('div')
  made.innerHTML = (await pictureFile({ graph: GRAPH, document: INFO, scheme: 'dark', ...NOTHING })).split('?>')[1] ?? ''
  expect(made.querySelector('svg')?.childElementCount).toBeGreaterThan(5)
  const shapes = (of: Element) =>
    [...of.querySelectorAll('*')].map((each) => [each.tagName, each.getAttribute('d'), each.getAttribute('x'), each.getAttribute('y')])
  expect(shapes(made)).toEqual(shapes(host))
  expect(made.textContent.trim()).toBe(host.textContent)
  expect(made.innerHTML).toContain(palette.green)
})

it('lays out what branches by the engine, and can open everything', async () => {
  const svg = await pictureFile({ graph: BRANCHING, document: INFO, scheme: 'light', ...NOTHING, all: true })
  expect(svg.startsWith('<?xml version="1.0" encoding="UTF-8"?>\n<svg xmlns="http://www.w3.org/2000/svg"')).toBe(true)
  expect(svg).toContain('shift &lt;1&gt;')
  expect(svg.match(/<path/g)?.length).toBe(5)
})

it('opens the containers of so many levels, and those that are named with what is around them', async () => {
  const inner = (path: string, children: readonly DocumentNode[]) => machineNode(path, children[0]?.name ?? '', children, [])
  const [deep, other] = ['root/one/two', 'root/other'].map((path) => inner(path, [node(`${path}/last`, ['done'])]))
  if (!deep || !other) throw new Error('there are two')
  const graph = inner('root', [inner('root/one', [deep]), other])
  const shown = async (opened: Partial<typeof NOTHING> | { readonly depth: number; readonly open?: readonly string[] }) => {
    const svg = await pictureFile({ graph, document: INFO, scheme: 'light', ...NOTHING, ...opened })
    return ['>two', '>last'].map((name) => svg.split(name).length - 1)
  }
  expect(await shown({ depth: 0 })).toEqual([0, 0])
  expect(await shown({ depth: 1 })).toEqual([1, 1])
  expect(await shown({ depth: 0, open: ['root/one/two'] })).toEqual([1, 1])
  expect(await shown({ depth: 2 })).toEqual([1, 2])
})

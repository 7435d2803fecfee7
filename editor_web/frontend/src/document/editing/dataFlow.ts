/** Who writes and who reads the userdata keys of a behavior, as lists and arrows show it. Pure. */
import { lookup } from '../dict'
import type { CatalogueBody, DocumentInfo, KeyFlow, KeyReader, KeyWriter } from '../../api/types'
import type { Box, Point } from '../geometry'
import { nodeOf, type EditNode } from './model'
import { pathsTo } from '../path'

/** From one that writes a key to one that reads it; an empty `from` is the behavior itself. */
export interface FlowLink {
  readonly key: string
  readonly from: string
  readonly to: string
  /** It may be reached without the key being defined. */
  readonly isUnsure: boolean
}

/** How well a key is defined where it is read, the worst of its readers. */
export type Soundness = 'sound' | 'maybe' | 'never'

export function soundnessOf(flow: KeyFlow): Soundness {
  const due = flow.readers.filter((reader) => reader.required || reader.by !== 'input')
  if (due.some((reader) => reader.defined === 'never')) return 'never'
  return due.some((reader) => reader.defined === 'maybe') ? 'maybe' : 'sound'
}

/** The arrows of one key, or of all. */
export function linksOf(flows: readonly KeyFlow[], key: string | undefined): readonly FlowLink[] {
  return flows
    .filter((flow) => key === undefined || flow.key === key)
    .flatMap((flow) =>
      flow.readers.flatMap((reader) =>
        reader.sources.map((from) => ({
          key: flow.key,
          from,
          to: reader.path,
          isUnsure: reader.defined === 'maybe',
        })),
      ),
    )
}

/** Arrows between what is drawn: those of nodes inside closed containers begin and end at these, each once. */
export function drawnLinks(links: readonly FlowLink[], drawn: ReadonlySet<string>): readonly FlowLink[] {
  const found = new Map<string, FlowLink & { keys: Set<string> }>()
  for (const link of links) {
    const from = link.from === '' ? '' : nearestDrawn(drawn, link.from)
    const to = nearestDrawn(drawn, link.to)
    if (from === undefined || to === undefined || from === to) continue
    const id = `${from} ${to}`
    const known = found.get(id)
    const keys = (known?.keys ?? new Set<string>()).add(link.key)
    found.set(id, {
      from,
      to,
      keys,
      key: [...keys].join(', '),
      isUnsure: link.isUnsure || (known?.isUnsure ?? false),
    })
  }
  return [...found.values()].map(({ key, from, to, isUnsure }) => ({ key, from, to, isUnsure }))
}

function nearestDrawn(drawn: ReadonlySet<string>, path: string): string | undefined {
  return pathsTo(path)
    .toReversed()
    .find((each) => drawn.has(each))
}

/** What a node reads and writes. */
export interface NodeFlow {
  readonly reads: readonly { readonly key: string; readonly reader: KeyReader }[]
  readonly writes: readonly {
    readonly key: string
    readonly writer: KeyWriter
    readonly readers: readonly string[]
  }[]
}

export function flowOfNode(flows: readonly KeyFlow[], path: string): NodeFlow {
  return {
    reads: flows.flatMap((flow) => flow.readers.filter((reader) => reader.path === path).map((reader) => ({ key: flow.key, reader }))),
    writes: flows.flatMap((flow) =>
      flow.writers
        .filter((writer) => writer.path === path)
        .map((writer) => ({
          key: flow.key,
          writer,
          readers: [...new Set(flow.readers.filter((each) => each.sources.includes(path)).map((each) => each.path))],
        })),
    ),
  }
}

/** Of what kind the values of a key are, as far as somebody says so: `number, m`. */
export function kindOfKey(
  flow: KeyFlow,
  root: EditNode | undefined,
  info: DocumentInfo | undefined,
  catalogue: CatalogueBody | undefined,
): string {
  const parameter = lookup(info?.parameters, flow.key)
  if (parameter) return [parameter['type'], parameter['unit']].filter((part) => typeof part === 'string').join(', ')
  const kinds = new Set<string>()
  for (const writer of flow.writers) {
    const node = nodeOf(root, writer.path)
    if (writer.origin === 'userdata') {
      const initial = writer.path === '' ? lookup(info?.userdata, flow.key) : lookup(node?.userdata, flow.key)
      if (initial !== null && initial !== undefined) kinds.add(kindOfValue(initial))
    }
    if (writer.origin === 'output') kinds.add(schemaKind(catalogue, node, 'outputs', writer.name))
    if (writer.origin === 'index') kinds.add('integer')
    if (writer.origin === 'collect') kinds.add('list')
  }
  for (const reader of flow.readers) {
    if (!['expression', 'collect', 'shared'].includes(reader.by))
      kinds.add(schemaKind(catalogue, nodeOf(root, reader.path), 'inputs', reader.name))
  }
  kinds.delete('')
  return [...kinds].join(' or ')
}

function schemaKind(catalogue: CatalogueBody | undefined, node: EditNode | undefined, part: 'inputs' | 'outputs', name: string): string {
  const state = catalogue?.states.find((each) => each.name === node?.state)
  const type = state?.[part].find((key) => key.name === name)?.schema['type']
  return typeof type === 'string' ? (type === 'array' ? 'list' : type) : ''
}

function kindOfValue(value: unknown): string {
  if (Array.isArray(value)) return 'list'
  return typeof value === 'object' ? 'mapping' : typeof value
}

/** A curve from one box to another, from edge to edge, bent a little so that it keeps off straight lines; where one is around the other, from its head. */
export function flowCurve(from: Box, to: Box): { readonly path: string; readonly middle: Point } {
  const start = holds(from, to) ? { x: from.x + 26, y: from.y + 20 } : edgeTowards(from, centre(to))
  const end = holds(to, from) ? { x: to.x + 26, y: to.y + 20 } : edgeTowards(to, start)
  const [dx, dy] = [end.x - start.x, end.y - start.y]
  const bend = Math.min(0.22, 46 / Math.max(1, Math.hypot(dx, dy)))
  const control = { x: (start.x + end.x) / 2 + dy * bend, y: (start.y + end.y) / 2 - dx * bend }
  return {
    path: `M ${start.x} ${start.y} Q ${control.x} ${control.y} ${end.x} ${end.y}`,
    middle: { x: (start.x + 2 * control.x + end.x) / 4, y: (start.y + 2 * control.y + end.y) / 4 },
  }
}

function centre(box: Box): Point {
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 }
}

function holds(outer: Box, inner: Box): boolean {
  const { x, y } = centre(inner)
  const isInside = x >= outer.x && x <= outer.x + outer.width && y >= outer.y && y <= outer.y + outer.height
  return isInside && outer.width >= inner.width && outer.height >= inner.height
}

/** Where the line from the middle of a box to a point leaves the box. */
function edgeTowards(box: Box, point: Point): Point {
  const middle = centre(box)
  const [dx, dy] = [point.x - middle.x, point.y - middle.y]
  if (dx === 0 && dy === 0) return middle
  const share = Math.min(dx === 0 ? Infinity : box.width / 2 / Math.abs(dx), dy === 0 ? Infinity : box.height / 2 / Math.abs(dy))
  return { x: middle.x + dx * share, y: middle.y + dy * share }
}

/** Machines that branch and come back are laid out by the layout engine, from port to port. */
import { edgeId, outcomeId } from '../edgeId'
import type { ElkShape, LayoutCall } from '../layout'
import type { Size } from '../geometry'
import { adopt, empty, put, type Content } from './content'
import { entryY, PILL_HEIGHT, pillWidth, portY } from './measure'
import { outgoingTransitions, type EditNode } from './model'

/** Where the port of an outcome is, from the top of its node. */
export function portOf(parent: EditNode, node: EditNode, outcome: string, box: Size): number {
  const outgoing = outgoingTransitions(parent, node)
  return portY(
    box.height,
    outgoing.length,
    Math.max(
      0,
      outgoing.findIndex((each) => each.outcome === outcome),
    ),
  )
}

/** Where arrows come into a child, or into an outcome, from its top. */
export function entryOf(parent: EditNode, name: string, box: Size): number {
  const child = parent.children.find((each) => each.name === name)
  return entryY(box.height, child ? outgoingTransitions(parent, child).length : 0)
}

interface Port extends ElkShape {
  layoutOptions: Record<string, string>
}

function port(id: string, x: number, y: number, side: 'WEST' | 'EAST'): Port {
  return { id, x, y, width: 0, height: 0, layoutOptions: { 'elk.port.side': side } }
}

const FIXED = { 'elk.portConstraints': 'FIXED_POS' }

export interface EngineOptions {
  readonly rowLimit: number
  readonly call: LayoutCall
}

export async function byEngine(
  node: EditNode,
  units: readonly Content[],
  drawn: readonly string[],
  options: EngineOptions,
): Promise<Content> {
  const children: (ElkShape & { ports: Port[] })[] = node.children.map((child, index) => {
    const { width, height } = units[index] ?? empty()
    const outgoing = outgoingTransitions(node, child)
    const outs = outgoing.map((each, row) => port(`${child.path}>${each.outcome}`, width, portY(height, outgoing.length, row), 'EAST'))
    const first: Record<string, string> = child.name === node.initial ? { 'elk.layered.layering.layerConstraint': 'FIRST' } : {}
    return {
      id: child.path,
      width,
      height,
      ports: [port(`${child.path}>`, 0, entryY(height, outgoing.length), 'WEST'), ...outs],
      layoutOptions: { ...FIXED, ...first },
    }
  })
  for (const outcome of drawn) {
    const id = outcomeId(node.path, outcome)
    children.push({
      id,
      width: pillWidth(outcome),
      height: PILL_HEIGHT,
      ports: [port(`${id}>`, 0, PILL_HEIGHT / 2, 'WEST')],
      layoutOptions: FIXED,
    })
  }
  const paths = new Map(node.children.map((child) => [child.name, child.path]))
  const edges = node.transitions.flatMap((t) => {
    const target = paths.get(t.target) ?? (drawn.includes(t.target) ? outcomeId(node.path, t.target) : undefined)
    const source = paths.get(t.source)
    return source && target
      ? [
          {
            id: edgeId({ machine: node.path, source: t.source, outcome: t.outcome }),
            sources: [`${source}>${t.outcome}`],
            targets: [`${target}>`],
          },
        ]
      : []
  })
  const graph: ElkShape = { id: node.path, children, edges, layoutOptions: { ...ENGINE, ...wrapping(node, options) } }
  const answer = await options.call(graph)
  const content = empty(answer.width ?? 0, answer.height ?? 0)
  const inner = new Map(node.children.map((child, index) => [child.path, units[index]]))
  for (const { id, x = 0, y = 0, width = 0, height = 0 } of answer.children ?? [])
    put(content, id, { x, y, width, height }, inner.get(id) ?? empty())
  for (const edge of answer.edges ?? []) {
    const section = edge.sections?.[0]
    if (section) content.routes.set(edge.id, [section.startPoint, ...(section.bendPoints ?? []), section.endPoint])
  }
  return fromTheLeft(content)
}

/** Arrows that come around the start of a row need room there too. */
function fromTheLeft(content: Content): Content {
  const xs = [...content.routes.values()].flatMap((points) => points.map((point) => point.x))
  const left = Math.min(0, ...xs)
  if (left === 0) return content
  const shifted = empty(content.width - left, content.height)
  adopt(shifted, content, { x: -left, y: 0 })
  return shifted
}

function ratio(rowLimit: number): number {
  return Math.max(1.2, Math.min(6, rowLimit / 600))
}

/** A long machine goes on in further rows. */
function wrapping(node: EditNode, { rowLimit }: EngineOptions): Record<string, string> {
  if (node.children.length < 6 || !Number.isFinite(rowLimit)) return {}
  return {
    'elk.layered.wrapping.strategy': 'MULTI_EDGE',
    'elk.layered.wrapping.additionalEdgeSpacing': '14',
    'elk.aspectRatio': String(ratio(rowLimit)),
  }
}

const ENGINE: Record<string, string> = {
  'elk.algorithm': 'layered',
  'elk.direction': 'RIGHT',
  'elk.edgeRouting': 'ORTHOGONAL',
  'elk.padding': '[top=4,left=0,bottom=0,right=0]',
  'elk.spacing.nodeNode': '26',
  'elk.spacing.edgeNode': '16',
  'elk.spacing.edgeEdge': '12',
  'elk.layered.spacing.nodeNodeBetweenLayers': '56',
  'elk.layered.spacing.edgeNodeBetweenLayers': '16',
  'elk.layered.spacing.edgeEdgeBetweenLayers': '12',
  'elk.layered.considerModelOrder.strategy': 'PREFER_NODES',
  'elk.layered.nodePlacement.strategy': 'BRANDES_KOEPF',
  'elk.layered.nodePlacement.bk.fixedAlignment': 'BALANCED',
}

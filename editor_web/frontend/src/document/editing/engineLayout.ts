/** Machines that branch and come back are laid out by the layout engine, from port to port. */
import { port } from '../branching'
import { COLUMNS, inColumns } from '../columns'
import { edgeId, outcomeId } from '../edgeId'
import type { ElkShape, LayoutCall } from '../elkGraph'
import type { Flow } from '../flow'
import type { Size } from '../geometry'
import { wrapped } from '../wrapping'
import { empty, put, type Content } from './content'
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

const FIXED = { 'elk.portConstraints': 'FIXED_POS' }

export interface EngineOptions {
  readonly rowLimit: number
  readonly call: LayoutCall
}

export async function byEngine(
  node: EditNode,
  units: readonly Content[],
  drawn: readonly string[],
  flow: Flow,
  { rowLimit, call }: EngineOptions,
): Promise<Content> {
  const inner = new Map(node.children.map((child, index) => [child.path, units[index]]))
  const byName = new Map(node.children.map((child) => [child.name, child]))
  const shapes = new Map<string, ElkShape>()
  for (const child of flow.order.flatMap((name) => byName.get(name) ?? [])) {
    const { width, height } = inner.get(child.path) ?? empty()
    const outgoing = outgoingTransitions(node, child)
    const outs = outgoing.map((each, row) => port(`${child.path}>${each.outcome}`, width, portY(height, outgoing.length, row), 'EAST'))
    shapes.set(child.name, {
      id: child.path,
      width,
      height,
      ports: [port(`${child.path}>`, 0, entryY(height, outgoing.length), 'WEST'), ...outs],
      layoutOptions: FIXED,
    })
  }
  for (const outcome of drawn) {
    const id = outcomeId(node.path, outcome)
    shapes.set(outcome, {
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
  const graph: ElkShape = { id: node.path, children: inColumns(flow, shapes), edges, layoutOptions: ENGINE }
  const answer = await call(graph)
  const rows = wrapped(
    {
      boxes: new Map((answer.children ?? []).map(({ id, x = 0, y = 0, width = 0, height = 0 }) => [id, { x, y, width, height }])),
      lines: (answer.edges ?? []).flatMap(({ id, sections }) => {
        const section = sections?.[0]
        return section ? [{ id, points: [section.startPoint, ...(section.bendPoints ?? []), section.endPoint] }] : []
      }),
    },
    rowLimit,
  )
  const content = empty(rows.width, rows.height)
  for (const [id, box] of rows.boxes) put(content, id, box, inner.get(id) ?? empty())
  for (const { id, points } of rows.lines) content.routes.set(id, points)
  return content
}

const ENGINE: Record<string, string> = {
  'elk.algorithm': 'layered',
  'elk.direction': 'RIGHT',
  'elk.edgeRouting': 'ORTHOGONAL',
  'elk.padding': '[top=0,left=0,bottom=0,right=0]',
  'elk.separateConnectedComponents': 'false',
  'elk.spacing.nodeNode': '26',
  'elk.spacing.edgeNode': '16',
  'elk.spacing.edgeEdge': '12',
  'elk.layered.spacing.nodeNodeBetweenLayers': '56',
  'elk.layered.spacing.edgeNodeBetweenLayers': '16',
  'elk.layered.spacing.edgeEdgeBetweenLayers': '12',
  ...COLUMNS,
  'elk.layered.nodePlacement.strategy': 'BRANDES_KOEPF',
  'elk.layered.nodePlacement.bk.fixedAlignment': 'LEFTUP',
}

/** Machines that branch and come back are laid out by the layout engine, as one long row that is then broken into several. */
import type { GraphNode } from '../api/types'
import { edgeId, edgeOf, outcomeId } from './edgeId'
import { COLUMNS, inColumns } from './columns'
import type { ElkArrow, ElkShape, LayoutCall } from './elkGraph'
import type { Flow } from './flow'
import type { Size } from './geometry'
import { wrapped } from './wrapping'

export type Direction = 'RIGHT' | 'DOWN'

/** How a behavior is laid out; to the right, a row longer than `rowLimit` pixels goes on in a further one. */
export interface Style {
  readonly direction: Direction
  readonly rowLimit: number
}

export interface Branching {
  readonly machine: GraphNode
  readonly flow: Flow
  /** How large its children are, by name. */
  readonly sizes: ReadonlyMap<string, Size>
  /** How wide those of its outcomes are that stand in the flow. */
  readonly outcomes: ReadonlyMap<string, number>
  readonly labelWidth: (outcome: string) => number
  /** From the top of a child to where its first arrows come and go, however tall it is. */
  readonly axis: number
}

export const OUTCOME_HEIGHT = 28
const LABEL_HEIGHT = 16
/** From one arrow that leaves a state to the next, where there is room for all of them. */
const BETWEEN_PORTS = 14

/** Places of its children and outcomes by their ids, and its arrows. */
export async function layOutBranching(branching: Branching, { direction, rowLimit }: Style, call: LayoutCall) {
  const { machine } = branching
  const paths = new Map(machine.children.map((child) => [child.name, child.path]))
  const endOf = (name: string) => paths.get(name) ?? (branching.outcomes.has(name) ? outcomeId(machine.path, name) : undefined)
  const laidOut = await call(graphOf(branching, endOf, direction))
  const targets = new Map(
    machine.transitions.map(({ source, outcome, target }) => [edgeId({ machine: machine.path, source, outcome }), target]),
  )
  const lines = (laidOut.edges ?? []).flatMap((arrow) => {
    const start = edgeOf(arrow.id)
    const section = arrow.sections?.[0]
    if (!start || !section) return []
    const { x = 0, y = 0, width = 0, height = 0 } = arrow.labels?.[0] ?? {}
    return [
      {
        id: arrow.id,
        source: endOf(start.source) ?? '',
        target: endOf(targets.get(edgeId(start)) ?? '') ?? '',
        outcome: start.outcome,
        points: [section.startPoint, ...(section.bendPoints ?? []), section.endPoint],
        label: { x: x + width / 2, y: y + height / 2, width },
      },
    ]
  })
  const boxes = new Map((laidOut.children ?? []).map(({ id, x = 0, y = 0, width = 0, height = 0 }) => [id, { x, y, width, height }]))
  return wrapped({ boxes, lines }, direction === 'RIGHT' ? rowLimit : Infinity)
}

function graphOf(branching: Branching, endOf: (name: string) => string | undefined, direction: Direction): ElkShape {
  const { machine, flow, sizes, outcomes, labelWidth, axis } = branching
  const drawn = machine.transitions.flatMap((transition) => {
    const [source, target] = [endOf(transition.source), endOf(transition.target)]
    return source && target ? [{ ...transition, source, target, id: edgeId({ ...transition, machine: machine.path }) }] : []
  })
  const children = flow.order.map((name): [string, ElkShape] => {
    const id = endOf(name) ?? ''
    const { width, height } = sizes.get(name) ?? { width: 0, height: 0 }
    const outgoing = drawn.filter(({ source }) => source === id)
    if (direction === 'DOWN') return [name, { id, width, height }]
    const step = Math.min(BETWEEN_PORTS, (axis - 6) / Math.max(1, outgoing.length - 1))
    const ports = [
      port(`${id}>`, 0, axis, 'WEST'),
      ...outgoing.map((each, index) => port(`${each.id}>`, width, axis + index * step, 'EAST')),
    ]
    return [name, { id, width, height, ports, layoutOptions: { 'elk.portConstraints': 'FIXED_POS' } }]
  })
  const ends = [...outcomes].map(([name, width]): [string, ElkShape] => [
    name,
    { id: outcomeId(machine.path, name), width, height: OUTCOME_HEIGHT },
  ])
  const inside = new Set(children.map(([, { id }]) => id))
  const edges = drawn.map(({ id, source, target, outcome }): ElkArrow => ({
    id,
    sources: [direction === 'DOWN' ? source : `${id}>`],
    targets: [direction === 'RIGHT' && inside.has(target) ? `${target}>` : target],
    labels: [{ text: outcome, width: labelWidth(outcome), height: LABEL_HEIGHT }],
  }))
  return { id: machine.path, children: inColumns(flow, new Map([...children, ...ends])), edges, layoutOptions: options(direction) }
}

/** A place at the border of a node where arrows come, or where one goes. */
export function port(id: string, x: number, y: number, side: 'WEST' | 'EAST'): ElkShape {
  return { id, x, y, width: 0, height: 0, layoutOptions: { 'elk.port.side': side } }
}

function options(direction: Direction): Record<string, string> {
  return {
    'elk.algorithm': 'layered',
    'elk.direction': direction,
    'elk.edgeRouting': 'ORTHOGONAL',
    'elk.padding': '[top=0,left=0,bottom=0,right=0]',
    'elk.separateConnectedComponents': 'false',
    'elk.spacing.nodeNode': '24',
    'elk.spacing.edgeNode': '14',
    'elk.spacing.edgeEdge': '12',
    'elk.layered.spacing.nodeNodeBetweenLayers': '20',
    'elk.layered.spacing.edgeNodeBetweenLayers': '14',
    'elk.layered.spacing.edgeEdgeBetweenLayers': '12',
    ...COLUMNS,
    'elk.layered.nodePlacement.strategy': 'BRANDES_KOEPF',
    'elk.layered.nodePlacement.bk.fixedAlignment': 'LEFTUP',
    'elk.edgeLabels.inline': 'true',
  }
}

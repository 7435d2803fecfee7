/** Graphs without the names of what is in them: those that are alike need to be laid out only once. Pure. */
import type { ElkArrow, ElkShape } from './elkGraph'

export interface Anonymous {
  readonly graph: ElkShape
  /** Give what was laid out its names back; others may share it, so it is not changed. */
  readonly named: (answer: ElkShape) => ElkShape
}

export function anonymous(graph: ElkShape): Anonymous {
  const given = new Map<string, string>()
  const names: string[] = []
  const hide = (id: string): string => {
    const known = given.get(id)
    if (known !== undefined) return known
    const short = names.length.toString(36)
    given.set(id, short)
    names.push(id)
    return short
  }
  const show = (short: string): string => names[Number.parseInt(short, 36)] ?? short
  return { graph: renamed(graph, hide), named: (answer) => renamed(answer, show) }
}

type Rename = (id: string) => string

function renamed(shape: ElkShape, to: Rename): ElkShape {
  const { id, ports, children, edges, ...rest } = shape
  return {
    id: to(id),
    ...rest,
    ...(ports && { ports: ports.map((port) => renamed(port, to)) }),
    ...(children && { children: children.map((child) => renamed(child, to)) }),
    ...(edges && { edges: edges.map((edge) => renamedArrow(edge, to)) }),
  }
}

function renamedArrow(arrow: ElkArrow, to: Rename): ElkArrow {
  return { ...arrow, id: to(arrow.id), sources: arrow.sources.map(to), targets: arrow.targets.map(to) }
}

/** How far a run is, told from the state of its nodes: its steps, those under way, and a count. Pure. */
import { lookup, type Dict } from './dict'
import type { GraphNode, NodeLive } from '../api/types'
import { pathsTo } from './path'

type Nodes = Dict<NodeLive>

/** More cells than this cannot be told apart. */
const MAX_STRIP_CELLS = 80

/** What the strip of a behavior is made of: its states in the order of the document; only the outer ones where there are too many. */
export function stripCells(root: GraphNode, limit = MAX_STRIP_CELLS): readonly GraphNode[] {
  let cells: readonly GraphNode[] = [root]
  for (;;) {
    const inner = cells.flatMap((node) => (node.children.length > 0 ? node.children : [node]))
    if (inner.length === cells.length && inner.every((node, index) => node === cells[index])) return cells
    if (inner.length > limit) return cells
    cells = inner
  }
}

/** The innermost active nodes, in the order in which they were entered. */
export function activeLeaves(nodes: Nodes): readonly string[] {
  const active = Object.keys(nodes).filter((path) => lookup(nodes, path)?.status === 'active')
  const above = new Set(active.flatMap((path) => pathsTo(path).slice(0, -1)))
  const leaves = active.filter((path) => !above.has(path))
  return leaves.toSorted((a, b) => (lookup(nodes, a)?.entered_s ?? 0) - (lookup(nodes, b)?.entered_s ?? 0) || a.localeCompare(b))
}

/** `2 of 5 steps done, 1 active, 1 failed`. A node that waits with its outcome is not done yet. */
export function progressText(cells: readonly GraphNode[], nodes: Nodes, waiting: readonly string[] = []): string {
  const count = (status: string) =>
    cells.filter((cell) => lookup(nodes, cell.path)?.status === status && !waiting.includes(cell.path)).length
  const waits = cells.filter((cell) => waiting.includes(cell.path)).length
  const more = [
    [count('active'), 'active'],
    [waits, waits === 1 ? 'waits' : 'wait'],
    [count('failed'), 'failed'],
    [count('stopped'), 'stopped'],
  ] as const
  const others = more.filter(([number]) => number > 0).map(([number, word]) => `${number} ${word}`)
  return [`${count('done')} of ${cells.length} ${cells.length === 1 ? 'step' : 'steps'} done`, ...others].join(', ')
}

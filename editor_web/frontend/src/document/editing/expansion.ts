/** Which containers show their inside, and what is drawn of a document. Pure. */
import { rowLimitFor } from '../rows'
import { allNodes, isFrame, isTreePart, type EditNode } from './model'

/** So many nodes are drawn at most without being asked for. */
const COMFORT = 50

/** The containers below `scope` that are open by themselves: from the outside in, as long as few nodes are drawn. */
export function expandedByDefault(scope: EditNode): ReadonlySet<string> {
  const open = new Set<string>()
  let drawn = scope.children.length
  let level: readonly EditNode[] = scope.children
  while (level.length > 0) {
    const frames = level.filter((node) => isFrame(node) || isTreePart(node.kind))
    const inside = frames.flatMap((node) => (node.kind === 'behavior' ? [] : node.children))
    if (drawn + inside.length > COMFORT) break
    frames.filter((node) => node.kind !== 'behavior').forEach((node) => open.add(node.path))
    drawn += inside.length
    level = inside
  }
  return open
}

/** The branches of a tree that fills the canvas are always seen. */
function onlyBranches(scope: EditNode): ReadonlySet<string> {
  const below = (node: EditNode): readonly string[] =>
    node.children.flatMap((child) => (isTreePart(child.kind) && child.kind !== 'tree' ? [child.path, ...below(child)] : []))
  return new Set(isTreePart(scope.kind) ? below(scope) : [])
}

/**
 * Is the inside of `path` shown? What was opened or closed by hand stays so, and what is in `kept` is not closed because
 * more is drawn by now.
 */
export function expansionOf(
  scope: EditNode,
  byHand: ReadonlyMap<string, boolean>,
  kept: ReadonlySet<string> = NONE,
): (path: string) => boolean {
  const byItself = expandedByDefault(scope)
  const branches = onlyBranches(scope)
  return (path) => byHand.get(path) ?? (byItself.has(path) || branches.has(path) || kept.has(path))
}

const NONE: ReadonlySet<string> = new Set()

/** So many nodes are an overview. */
const MANY = 300

/**
 * The longest row where `scope` fills the canvas. What is opened and closed by hand breaks no row anew, until so much is
 * open that it is an overview.
 */
export function rowLimitOf(scope: EditNode, isOpen: (path: string) => boolean): number {
  const drawn = drawnNodes(scope, isOpen).length
  return rowLimitFor(drawn > MANY ? drawn : drawnNodes(scope, expansionOf(scope, BY_NOBODY)).length)
}

const BY_NOBODY: ReadonlyMap<string, boolean> = new Map()

/** The nodes that are drawn when `scope` fills the canvas, parents before children. */
export function drawnNodes(scope: EditNode, isOpen: (path: string) => boolean): readonly EditNode[] {
  return scope.children.flatMap((child) => [child, ...(isOpen(child.path) ? drawnNodes(child, isOpen) : [])])
}

/** The container in whose frame a node is drawn: the nearest one above it that is no branch of a tree. */
export function frameOf(scope: EditNode, path: string): EditNode {
  let frame = scope
  for (let next: EditNode | undefined = scope; next;) {
    if (next === scope || next.kind === 'tree' || !isTreePart(next.kind)) frame = next
    next = next.children.find((child) => path.startsWith(`${child.path}/`))
  }
  return frame
}

/** Outcomes of a machine that nothing inside leads to yet: those of the behavior, and those used outside. */
export function declaredOutcomes(root: EditNode, outcomes: readonly string[]): (node: EditNode) => readonly string[] {
  return (node) => {
    if (node === root) return outcomes
    return node.outcomes
  }
}

/** Count of the nodes inside. */
export function countInside(node: EditNode): number {
  return allNodes(node).length - 1
}

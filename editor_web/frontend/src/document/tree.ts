/** Looking things up in a behavior's tree of nodes. Pure. */
import type { GraphNode } from '../api/types'

/** All nodes, parents before children. */
export function flatten(root: GraphNode): readonly GraphNode[] {
  return [root, ...root.children.flatMap(flatten)]
}

/** The node at a path. */
export function nodeAt(root: GraphNode, path: string): GraphNode | undefined {
  return flatten(root).find((node) => node.path === path)
}

/** Is it drawn with its children inside? */
export function isContainer(node: GraphNode): boolean {
  return node.children.length > 0
}

/** The kind of a node in words. */
export function kindLabel(kind: string): string {
  switch (kind) {
    case 'machine':
      return 'State machine'
    case 'concurrency':
      return 'Concurrency'
    case 'behavior':
      return 'Behavior'
    case 'state':
      return 'State'
    default:
      return (kind.charAt(0).toUpperCase() + kind.slice(1)).replaceAll('_', ' ')
  }
}

/** A behavior with folded containers: each is drawn as one box, without what is inside. Pure. */
import type { GraphNode } from '../api/types'
import { pathsTo } from './path'
import { flatten, isContainer, kindLabel } from './tree'

/** The paths of folded containers. */
export type Folded = ReadonlySet<string>

/** The behavior as it is drawn; parts without a folded container are the same objects. */
export function folded(root: GraphNode, paths: Folded): GraphNode {
  if (paths.size === 0) return root
  if (isContainer(root) && paths.has(root.path)) {
    return { ...root, title: foldedTitle(root), children: [], transitions: [], initial: null, conditions: [] }
  }
  const children = root.children.map((child) => folded(child, paths))
  return children.every((child, index) => child === root.children[index]) ? root : { ...root, children }
}

/** `State machine of 12`: how many states are inside, at any depth. */
function foldedTitle(node: GraphNode): string {
  const inside = flatten(node).filter((each) => !isContainer(each)).length
  return `${kindLabel(node.kind)} of ${inside}`
}

/** The node that stands for one that is inside a folded container; itself where it is drawn. */
export function drawnAt(path: string, paths: Folded): string {
  return pathsTo(path).find((each) => each !== path && paths.has(each)) ?? path
}

/** Without the folded containers around a node, so that it is drawn. */
export function unfoldedTo(path: string, paths: Folded): Folded {
  const around = new Set(pathsTo(path).filter((each) => each !== path))
  return new Set([...paths].filter((each) => !around.has(each)))
}

/** Without a container where it is folded, else with it. */
export function toggled(path: string, paths: Folded): Folded {
  return paths.has(path) ? new Set([...paths].filter((each) => each !== path)) : new Set([...paths, path])
}

/** The containers inside `root` with nothing active in them, the outermost of each; none where nothing is active. */
export function inactive(root: GraphNode, isActive: (path: string) => boolean): readonly string[] {
  if (!flatten(root).some((node) => isActive(node.path))) return []
  return root.children.filter(isContainer).flatMap((child) => (holdsActive(child, isActive) ? inactive(child, isActive) : [child.path]))
}

function holdsActive(node: GraphNode, isActive: (path: string) => boolean): boolean {
  return flatten(node).some((each) => isActive(each.path))
}

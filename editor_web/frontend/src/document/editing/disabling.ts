/** Passing nodes over: which outcome each is passed with, and the edits that disable or enable several at once. Pure. */
import { setField, type Edit } from './edits'
import { isFailure, isForeign, isTreePart, nodeOf, ROOT, type EditNode } from './model'
import { parentPath, pathsTo } from '../path'

/** The edits, or why there are none. */
export interface Disabling {
  readonly edits: readonly Edit[]
  readonly isEnabling: boolean
  readonly obstacle: string | undefined
}

/** Enable the nodes where all are disabled, else disable those that are not. */
export function disabling(root: EditNode, paths: readonly string[]): Disabling {
  const nodes = paths.filter((path) => path !== ROOT && !isForeign(root, path)).flatMap((path) => nodeOf(root, path) ?? [])
  const isEnabling = nodes.length > 0 && nodes.every((node) => node.disabled !== false)
  if (nodes.length === 0) return { edits: [], isEnabling, obstacle: 'the behavior as a whole cannot be disabled' }
  if (isEnabling) return { edits: nodes.map((node) => setField(node.path, 'disabled', null)), isEnabling, obstacle: undefined }
  const edits: Edit[] = []
  for (const node of nodes) {
    if (node.disabled !== false) continue
    const value = passing(root, node)
    if (value === undefined) return { edits: [], isEnabling, obstacle: `${node.name} has no outcome with which it could be passed over` }
    edits.push(setField(node.path, 'disabled', value))
  }
  return { edits, isEnabling, obstacle: undefined }
}

/** What stands under `disabled`: true in a tree, else the outcome that leads on most likely. */
export function passing(root: EditNode, node: EditNode): true | string | undefined {
  if (isTreePart(nodeOf(root, parentPath(node.path))?.kind ?? '')) return true
  const good = node.outcomes.filter((outcome) => !isFailure(outcome))
  return good.find((outcome) => outcome in node.targets) ?? good[0] ?? node.outcomes[0]
}

/** Is the node, or something around it, passed over? */
export function isPassedOver(root: EditNode, path: string): boolean {
  return pathsTo(path).some((each) => {
    const node = nodeOf(root, each)
    return node !== undefined && node.disabled !== false
  })
}

/** What is written on a disabled node: that it is, and how a run goes on. */
export function disabledText(disabled: boolean | string): string {
  return typeof disabled === 'string' ? `disabled → ${disabled}` : 'disabled'
}

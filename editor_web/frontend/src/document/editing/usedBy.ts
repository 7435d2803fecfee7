/** What can be looked for in the behaviors of the project, and what of it a node runs. Pure. */
import type { EditNode } from './model'

export type UsedKind = 'state' | 'behavior' | 'entry' | 'key'

/** Something that behaviors use; its name is empty where it is still to be typed. */
export interface Used {
  readonly kind: UsedKind
  readonly name: string
}

/** The state or behavior that a node runs; undefined for other containers. */
export function usedBy(node: Pick<EditNode, 'kind' | 'title' | 'document'> | undefined): Used | undefined {
  if (!node) return undefined
  if (node.document) return { kind: 'behavior', name: node.document }
  return node.kind === 'state' && node.title ? { kind: 'state', name: node.title } : undefined
}

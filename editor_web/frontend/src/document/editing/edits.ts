/** Making edits of a document, which the server applies. Pure. */
import type { Edit, GroupNodes } from '../../api/types'

export type { AddNode, Edit } from '../../api/types'

export type Corner = readonly [number, number]
export type GroupKind = GroupNodes['kind']

/** Set one thing of a node; null takes it away. */
export function setField(path: string, field: string, value: unknown): Edit {
  return { edit: 'set_field', path, field, value }
}

/** Whole pixels; nobody reads the digits behind the point. */
export function corner(x: number, y: number): Corner {
  return [Math.round(x), Math.round(y)]
}

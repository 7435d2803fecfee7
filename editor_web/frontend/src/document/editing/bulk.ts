/** What several nodes have in common, and the edits that set it in all of them. Pure. */
import { lookup } from '../dict'
import { setField, type Edit } from './edits'
import type { EditNode } from './model'

/** The parameters that all of them take, in the order of the first. */
export function commonParameters(parametersOf: (node: EditNode) => readonly string[], nodes: readonly EditNode[]): readonly string[] {
  const [first, ...others] = nodes.map(parametersOf)
  return first?.filter((name) => others.every((names) => names.includes(name))) ?? []
}

/** The value that a parameter has in all of them; `undefined` where none has one, `MIXED` where they differ. */
export function commonValue(nodes: readonly EditNode[], name: string): unknown {
  const [first, ...others] = nodes.map((node) => JSON.stringify(lookup(node.parameters, name)))
  return others.every((value) => value === first) ? lookup(nodes[0]?.parameters ?? {}, name) : MIXED
}

export const MIXED = Symbol('different values')

/** Set a parameter of all of them; without a value its default applies. */
export function setParameterOfAll(nodes: readonly EditNode[], name: string, value: unknown): readonly Edit[] {
  if (value !== undefined) return nodes.map(({ path }): Edit => ({ edit: 'set_parameter', path, name, value }))
  return nodes.filter((node) => name in node.parameters).map(({ path }): Edit => ({ edit: 'clear_parameter', path, name }))
}

/** Write the same note on all of them. */
export function noteOnAll(nodes: readonly EditNode[], text: string): readonly Edit[] {
  return nodes.map((node) => setField(node.path, 'notes', text.trim() || null))
}

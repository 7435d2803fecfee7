/** Ids of what joins nodes in a drawing: arrows of machines, and the places of their outcomes. Made and read here only. */

declare const IS_EDGE: unique symbol
declare const IS_OUTCOME: unique symbol

/** Names an arrow of a machine. */
export type EdgeId = string & { readonly [IS_EDGE]: true }

/** Names the place of an outcome of a machine. */
export type OutcomeId = string & { readonly [IS_OUTCOME]: true }

/** Where an arrow begins: the machine by its path, the child by its name, and the outcome that leads away. */
export interface EdgeStart {
  readonly machine: string
  readonly source: string
  readonly outcome: string
}

/** Begins nowhere. */
export const NO_EDGE: EdgeStart = { machine: '', source: '', outcome: '' }

/** No name of a node or an outcome has what parts them here. */
const EDGE = /^([^|]+)\|([^|]+)\|([^|]+)$/

export function edgeId({ machine, source, outcome }: EdgeStart): EdgeId {
  return `${machine}|${source}|${outcome}` as EdgeId
}

export function isEdgeId(id: string): id is EdgeId {
  return EDGE.test(id)
}

/** Where the arrow begins that an id names; undefined where it names none. */
export function edgeOf(id: string): EdgeStart | undefined {
  const [, machine, source, outcome] = EDGE.exec(id) ?? []
  return machine !== undefined && source !== undefined && outcome !== undefined ? { machine, source, outcome } : undefined
}

/** The path of the node at which an arrow begins. */
export function sourceOf({ machine, source }: EdgeStart): string {
  return `${machine}/${source}`
}

export function outcomeId(machine: string, outcome: string): OutcomeId {
  return `${machine}#${outcome}` as OutcomeId
}

/** Which outcome of which machine an id names; undefined where it names none. */
export function outcomeOf(id: string): { readonly machine: string; readonly outcome: string } | undefined {
  const at = id.indexOf('#')
  return at < 0 ? undefined : { machine: id.slice(0, at), outcome: id.slice(at + 1) }
}

/** How the server names, at a machine, the transition that was taken last. */
export function transitionId({ source, outcome }: Pick<EdgeStart, 'source' | 'outcome'>): string {
  return `${source}|${outcome}`
}

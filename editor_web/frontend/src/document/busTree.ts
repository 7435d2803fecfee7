/** The names of a bus grouped by their namespaces, and found by a search. Pure. */
import { parentPath } from './path'

export interface Named {
  readonly name: string
  readonly type: string
  readonly doc: string
}

export interface Namespace<T extends Named> {
  readonly name: string
  readonly entries: readonly T[]
}

/** Those that have all words of the search in name, type or text. */
export function found<T extends Named>(entries: readonly T[], search: string): readonly T[] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean)
  if (words.length === 0) return entries
  return entries.filter((entry) => {
    const text = `${entry.name} ${entry.type} ${entry.doc}`.toLowerCase()
    return words.every((word) => text.includes(word))
  })
}

/** Entries by what stands before the last slash of their names, in the order of names. */
export function byNamespace<T extends Named>(entries: readonly T[]): readonly Namespace<T>[] {
  const groups = new Map<string, T[]>()
  for (const entry of entries.toSorted((a, b) => (a.name < b.name ? -1 : 1))) {
    const name = parentPath(entry.name)
    const group = groups.get(name)
    if (group) group.push(entry)
    else groups.set(name, [entry])
  }
  return [...groups].map(([name, of]) => ({ name, entries: of })).toSorted((a, b) => (a.name < b.name ? -1 : 1))
}

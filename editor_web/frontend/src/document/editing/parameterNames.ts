/** What a parameter of a behavior may be declared to name, and the names that fit it. Pure. */
import type { EntryName } from '../../api/types'
import { lookup, type Dict } from '../dict'

type Mapping = Dict<unknown>

export interface NameSources {
  /** The names that the cell of the document has, by kind. */
  readonly names: Dict<readonly string[]>
  readonly entries: readonly EntryName[]
}

export interface NameKind {
  readonly value: string
  readonly label: string
}

/** Kinds that a parameter can name, with the one that it has: `cell_name robot`, `entry joints`. */
export function nameKinds({ names, entries }: NameSources, parameter: Mapping): readonly NameKind[] {
  const kinds = [
    ...Object.keys(names)
      .toSorted()
      .map((kind) => `cell_name ${kind}`),
    ...[...new Set(entries.map(({ kind }) => kind))].toSorted().map((kind) => `entry ${kind}`),
  ]
  const own = nameKindOf(parameter)
  return (own && !kinds.includes(own) ? [own, ...kinds] : kinds).map((value) => ({ value, label: labelOf(value) }))
}

export function nameKindOf(parameter: Mapping): string {
  const word = ['cell_name', 'entry'].find((key) => typeof lookup(parameter, key) === 'string')
  return word ? `${word} ${String(lookup(parameter, word))}` : ''
}

/** What is written for a kind: one of the two words, without the other. */
export function namingOf(value: string): { readonly cell_name: string | undefined; readonly entry: string | undefined } {
  const [word, kind] = value.split(' ')
  return { cell_name: word === 'cell_name' ? kind : undefined, entry: word === 'entry' ? kind : undefined }
}

/** The names that fit a declared parameter; none where it names nothing. */
export function fittingNames({ names, entries }: NameSources, parameter: Mapping): readonly string[] {
  const { cell_name: kind, entry } = namingOf(nameKindOf(parameter))
  if (entry) return entries.filter((each) => each.kind === entry).map(({ name }) => name)
  return kind ? (lookup(names, kind) ?? []) : []
}

function labelOf(value: string): string {
  const [word, kind = ''] = value.split(' ')
  return word === 'entry' ? `entry: ${kind}` : kind.replaceAll('_', ' ')
}

/** What a field offers to choose from: names of the cell and of its store, each with what it is and how it is now. Pure. */
import type { CellItem, EntryName } from '../../api/types'
import { holderOf, stateWords, type CellNow } from '../cellTree'
import { lookup, type Dict } from '../dict'
import { firstOfPath } from '../path'
import { isTemplate, type EditField } from './fields'
import { byDefault, entryNamed } from './preview'

/** One name to choose. */
export interface Offer {
  readonly text: string
  /** What it is, and how it is now. */
  readonly detail: string
}

/** What is known of the cell and the behavior. */
export interface Surroundings {
  /** The names that the cell of the document has, by kind. */
  readonly names: Dict<readonly string[]>
  readonly entries: readonly EntryName[]
  /** The values of the other parameters of the node. */
  readonly given: Dict<unknown>
  /** The parameters of the behavior. */
  readonly parameters: Dict<Dict<unknown>>
  /** The names that states of the behavior add to the cell, and the entries that they write. */
  readonly added: readonly string[]
  /** Whether the entries are those of the cell of the document. */
  readonly isOpenCell: boolean
  /** The items of the open cell and how they are now; undefined while nobody looks, or where the document is about another cell. */
  readonly open: { readonly items: readonly CellItem[]; readonly now: CellNow; readonly outputs: readonly boolean[] } | undefined
}

/** Kinds of which there may be more while a cell is open, as states add them. */
const GROWING = new Set(['body', 'obstacle', 'scene_part'])

/** The value of another parameter, by default where it is an expression. */
function otherValue(name: string, { given, parameters }: Surroundings): string {
  const value = entryNamed(lookup(given, name))
  return value === undefined ? '' : (byDefault(value, parameters) ?? '')
}

/** What can be chosen in a field; undefined where nothing is known that fits. */
export function offersOf(field: EditField, around: Surroundings): readonly Offer[] | undefined {
  if (field.kind === 'entry' || field.entryKind || field.entryOf) return entryOffers(field, around)
  if (field.examples.length > 0) return kindOffers(field, around)
  if (!field.nameKind) return undefined
  const names = namesOf(field, around)
  if (!names) return undefined
  const added = GROWING.has(field.nameKind) ? around.added.filter((name) => !names.includes(name)) : []
  return [
    ...field.namesBeside.map((text) => ({ text, detail: 'of this state' })),
    ...names.map((text) => ({ text, detail: detailOf(text, field, around) })),
    ...added.map((text) => ({ text, detail: 'added by a state' })),
  ]
}

/** The names that fit; of what another parameter names, without its name before them. */
function namesOf(field: EditField, around: Surroundings): readonly string[] | undefined {
  const known = lookup(around.names, field.nameKind)
  if (!known || !field.nameOf) return known
  const owner = `${otherValue(field.nameOf, around)}/`
  const own = known.filter((name) => name.startsWith(owner)).map((name) => name.slice(owner.length))
  return field.kind === 'integer' ? own.filter((name) => /^\d+$/.test(name)) : own
}

function entryOffers(field: EditField, around: Surroundings): readonly Offer[] {
  const kind = field.entryOf ? otherValue(field.entryOf, around) : field.entryKind
  return around.entries
    .filter((entry) => !kind || entry.kind === kind)
    .map((entry) => ({ text: entry.name, detail: field.isFreeName && field.kind === 'text' ? 'exists' : kind ? '' : entry.kind }))
}

/** The usual kinds of entries, and those that the store has beside. */
function kindOffers(field: EditField, { entries }: Surroundings): readonly Offer[] {
  const counts = new Map<string, number>(field.examples.map((kind) => [kind, 0]))
  for (const { kind } of entries) counts.set(kind, (counts.get(kind) ?? 0) + 1)
  return [...counts].map(([text, count]) => ({ text, detail: count === 1 ? '1 entry' : count > 0 ? `${count} entries` : '' }))
}

function detailOf(name: string, field: EditField, around: Surroundings): string {
  const { open } = around
  switch (field.nameKind) {
    case 'output':
      return outputWords(name, open?.outputs ?? [])
    case 'frame':
    case 'arm_frame':
    case 'link':
    case 'body':
    case 'obstacle':
    case 'scene_part':
      return join(bodyWords(name, around), open && holderWords(name, open.now))
    default: {
      const item = open?.items.find((each) => each.name === name && each.kind !== 'tool')
      const tool = open?.items.find((each) => each.name === name && each.kind === 'tool')
      const isDevice = field.nameKind === 'robot' || field.nameKind === 'controller'
      // A robot that is named as a gripper is asked for its tool.
      const shown = item?.kind === 'robot' && !isDevice ? (tool ?? item) : item
      if (!shown || !open) return ''
      const node = { address: shown.path, kind: shown.kind, name, detail: '', item: shown, children: [] }
      return join(shown.model, stateWords(node, open.now)?.words)
    }
  }
}

function bodyWords(name: string, { names, open }: Surroundings): string {
  if (name === 'world') return 'the world'
  if (lookup(names, 'robot')?.includes(name)) return 'robot'
  if (lookup(names, 'part')?.includes(name)) return 'part'
  const item = open?.items.find((each) => each.name === name)
  if (item) return item.kind
  return name.includes('/') ? `link of ${firstOfPath(name)}` : ''
}

function holderWords(name: string, now: CellNow): string | undefined {
  const holder = holderOf(name, now.state)
  return holder && `held by ${holder}`
}

function outputWords(name: string, outputs: readonly boolean[]): string {
  const value = /^\d+$/.test(name) ? outputs[Number(name)] : undefined
  return value === undefined ? '' : value ? 'on' : 'off'
}

function join(...words: readonly (string | undefined)[]): string {
  return words.filter(Boolean).join(', ')
}

const MOST_LISTED = 4

/** What is wrong with a name that nothing has; the check of the server says it for expressions too. */
export function unknownName(field: EditField, value: unknown, around: Surroundings): string | undefined {
  const named = field.kind === 'entry' ? entryNamed(value) : typeof value === 'number' ? String(value) : value
  if (typeof named !== 'string' || named === '' || isTemplate(named) || field.isFreeName || around.added.includes(named)) return undefined
  if (field.kind === 'entry') return entryProblem(named, field, around)
  const offers = field.nameKind ? offersOf(field, around) : undefined
  if (!offers || offers.some((each) => each.text === named)) return undefined
  // What belongs to something unknown, or to something without a model, cannot be told from a mistake.
  if ((field.nameOf || named.includes('/')) && offers.length === 0) return undefined
  const known = offers.map((each) => each.text)
  const words = field.nameKind.replaceAll('_', ' ')
  const has = known.length === 0 ? 'none' : known.length > MOST_LISTED ? `${known.slice(0, MOST_LISTED).join(', ')} …` : known.join(', ')
  const more = GROWING.has(field.nameKind) ? ', and no state of this behavior adds it' : ''
  return `The cell has no ${words} “${named}”${more}; it has: ${has}`
}

function entryProblem(named: string, field: EditField, around: Surroundings): string | undefined {
  if (!around.isOpenCell || around.entries.length === 0) return undefined
  const fits = around.entries.some((entry) => entry.name === named && (!field.entryKind || entry.kind === field.entryKind))
  return fits ? undefined : `The store has no ${field.entryKind ? `${field.entryKind} ` : ''}entry “${named}”`
}

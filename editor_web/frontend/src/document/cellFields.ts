/** The fields of a form of an item of a cell: what each holds, where it is in the value, and values as a form shows them. Pure. */
import type { DraftItem } from '../api/types'
import { fieldsOf, lookup, type Dict } from './dict'

export type Section = DraftItem['section']

/** What an item can be related to. */
export interface Surroundings {
  /** All that something may stand in. */
  readonly frames: readonly string[]
  readonly connectors: readonly string[]
  /** The folders of modules, as the document writes them. */
  readonly folders: readonly string[]
  /** The models of robots, and of tools. */
  readonly robots: readonly string[]
  readonly tools: readonly string[]
  readonly fixtures: readonly string[]
  readonly parts: readonly string[]
  readonly equipment: readonly string[]
  /** The positions of each device, by its name in the cell. */
  readonly positions: Dict<readonly string[]>
}

interface FieldBase {
  /** From the item inward. */
  readonly path: readonly string[]
  readonly label: string
  /** What holds where nothing is written; undefined where that is nothing. */
  readonly usual: unknown
}

export type Field =
  /** The choice of `none` writes nothing. */
  | (FieldBase & { readonly kind: 'choice'; readonly choices: readonly string[]; readonly none?: string })
  | (FieldBase & {
      readonly kind: 'numbers'
      readonly names: readonly string[]
      readonly unit: string
      readonly isAngle: boolean
      readonly minimum?: number
      /** Said where nothing is written; without it there is always a number. */
      readonly absent?: string
    })
  | (FieldBase & { readonly kind: 'colour' })
  | (FieldBase & { readonly kind: 'switch' })
  | (FieldBase & { readonly kind: 'text'; readonly pattern?: RegExp; readonly hint?: string })
  /** Several of the choices. */
  | (FieldBase & { readonly kind: 'names'; readonly choices: readonly string[] })
  /** On or off for each of the names; `isOpen` takes others too. */
  | (FieldBase & { readonly kind: 'levels'; readonly choices: readonly string[]; readonly isOpen: boolean })
  /** What is done one after the other towards a position of a device. */
  | (FieldBase & { readonly kind: 'steps'; readonly outputs: readonly string[]; readonly sensors: readonly string[] })
  | (FieldBase & { readonly kind: 'interlocks'; readonly own: readonly string[]; readonly others: Dict<readonly string[]> })

/** Fields that belong together; `entry` is what of a device they are of, by its group and name: `axes`, `main`. */
export interface FieldGroup {
  readonly title: string
  readonly entry?: readonly [string, string]
  readonly fields: readonly Field[]
}

export function numbersAt(
  label: string,
  path: readonly string[],
  names: readonly string[],
  unit: string,
  usual: unknown,
): Field & { kind: 'numbers' } {
  return { kind: 'numbers', path, label, names, unit, usual, isAngle: false }
}

/** A text or a number as text; nothing where neither is. */
export function wordsOf(value: unknown): string {
  return typeof value === 'string' ? value : typeof value === 'number' ? String(value) : ''
}

export function keyOf(path: readonly string[]): string {
  return path.join('.')
}

/** What is at a path of a value; undefined where nothing is. */
export function valueAt(value: unknown, path: readonly string[]): unknown {
  return path.reduce((now: unknown, step) => lookup(fieldsOf(now), step), value)
}

/** The same value with another one at a path. */
export function withValue(value: Dict<unknown>, [first, ...rest]: readonly string[], to: unknown): Dict<unknown> {
  if (first === undefined) return value
  return { ...value, [first]: rest.length === 0 ? to : withValue(fieldsOf(lookup(value, first)), rest, to) }
}

export function numbersOf(value: unknown): readonly number[] {
  const all = Array.isArray(value) ? (value as unknown[]) : [value]
  return all.filter((each) => typeof each === 'number')
}

const DEGREE = Math.PI / 180

/** Numbers as the form shows them: degrees of radians. */
export function shownNumbers(field: Field & { readonly kind: 'numbers' }, value: unknown): readonly number[] {
  const written = numbersOf(value ?? field.usual)
  return field.names.map((_, at) => (written[at] ?? 0) / (field.isAngle ? DEGREE : 1))
}

/** What the document has for the numbers of the form; those that were not changed stay as they are written, to the last digit. */
export function writtenNumbers(field: Field & { readonly kind: 'numbers' }, value: unknown, shown: readonly number[]): unknown {
  const before = shownNumbers(field, value)
  const written = numbersOf(value ?? field.usual)
  const made = shown.map((each, at) => {
    const old = written[at]
    if (old !== undefined && each === before[at]) return old
    return Number((field.isAngle ? each * DEGREE : each).toFixed(6))
  })
  return Array.isArray(value ?? field.usual) || field.names.length > 1 || field.path[0] === 'size_m' ? made : made[0]
}

export function isSame(a: unknown, b: unknown): boolean {
  return JSON.stringify(a ?? null) === JSON.stringify(b ?? null)
}

/** Where two values differ, from the item inward, with what is there then; null where nothing is. */
export function differences(
  before: Dict<unknown>,
  after: Dict<unknown>,
  path: readonly string[] = [],
): readonly (readonly [readonly string[], unknown])[] {
  return [...new Set([...Object.keys(before), ...Object.keys(after)])].flatMap((key) => {
    const [was, is] = [lookup(before, key), lookup(after, key)]
    if (isSame(was, is)) return []
    const inner = [...path, key]
    return isMapping(was) && isMapping(is) ? differences(was, is, inner) : [[inner, is ?? null] as const]
  })
}

function isMapping(value: unknown): value is Dict<unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value)
}

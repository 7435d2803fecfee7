/** From a state's JSON Schema to the fields of the editor's form, and values to and from what is typed. Pure. */
import type { KeyView } from '../../api/types'
import { lookup, without, type Dict } from '../dict'
import { isJson } from '../schema'

export type Schema = Dict<unknown>

export type EditFieldKind = 'number' | 'integer' | 'boolean' | 'text' | 'choice' | 'vector' | 'entry' | 'record' | 'list' | 'data'

export interface EditField {
  readonly name: string
  readonly kind: EditFieldKind
  readonly description: string
  readonly unit: string
  readonly required: boolean
  readonly isNullable: boolean
  readonly minimum: number | undefined
  readonly maximum: number | undefined
  /** The limit itself is not allowed. */
  readonly isOpenBelow: boolean
  readonly choices: readonly string[]
  /** Names of the numbers of a vector. */
  readonly parts: readonly string[]
  /** Kind of the named entries that fit; the whole value is the name where `isPlainEntry`. */
  readonly entryKind: string
  readonly isPlainEntry: boolean
  /** The parameter that names the kind of entry, where the value is the name of one. */
  readonly entryOf: string
  /** Kind of names of the cell that fit; empty for none. */
  readonly nameKind: string
  /** Another name is no mistake: it is one for messages, or that of an entry or thing to be made. */
  readonly isFreeName: boolean
  /** Names that always fit beside those of the cell. */
  readonly namesBeside: readonly string[]
  /** Values that are usual, where others are possible. */
  readonly examples: readonly string[]
  /** The parameter that names what the name is of: the robot of a link. */
  readonly nameOf: string
  /** The parameter that names the arm whose joints the value may be; empty where it is no configuration. */
  readonly jointsOf: string
  /** The topic below the name of the robot that tells how great the quantity is now; empty for none. */
  readonly measuredOn: string
  /** The fields of a value that has fields; without `entry`, which stands for the whole value. */
  readonly properties: readonly EditField[]
  /** What each item of a list is; undefined where it is no list of values with fields. */
  readonly item: EditField | undefined
  readonly fallback: unknown
}

/** Describe one parameter of a state as a field. */
export function editFieldOf(key: KeyView): EditField {
  return fieldFrom(key, record(key.schema['$defs']), 0)
}

// A target has fields, and those of a frame are plain.
const DEEPEST = 3

function fieldFrom(key: KeyView, definitions: Schema, depth: number): EditField {
  const { schema, isNullable, jointsOf } = resolved(key.schema, definitions)
  const combined = { ...schema, ...withoutShape(key.schema) }
  const properties = record(schema['properties'])
  const entry = record(properties['entry'])
  const choices = Array.isArray(schema['enum']) ? schema['enum'].map(String) : []
  const parts = partsOf(schema)
  const plainEntry = text(combined['entry'])
  const isTarget = 'entry' in properties
  const required = Array.isArray(schema['required']) ? schema['required'] : []
  const inner = Object.entries(depth < DEEPEST ? properties : {})
    .filter(([name]) => name !== 'entry')
    .map(([name, each]) =>
      fieldFrom(
        { name, required: required.includes(name), default: record(each)['default'], schema: record(each) },
        definitions,
        depth + 1,
      ),
    )
  const listed = schema['type'] === 'array' && depth < DEEPEST ? record(schema['items']) : {}
  const item =
    '$ref' in listed || 'properties' in listed
      ? fieldFrom({ name: '', required: true, default: null, schema: listed }, definitions, depth + 1)
      : undefined
  const newEntry = text(combined['new_entry']) || text(combined['new_entry_of'])
  const label = text(combined['cell_label'])
  return {
    name: key.name,
    kind: kindOf(schema, {
      isEntry: plainEntry !== '' || isTarget,
      hasChoices: choices.length > 0,
      isVector: parts.length > 0,
      isRecord: inner.length > 0,
      isList: item?.kind === 'record',
    }),
    description: text(combined['description']),
    unit: text(combined['unit']),
    required: key.required,
    isNullable,
    minimum: numeric(schema['minimum']) ?? numeric(schema['exclusiveMinimum']),
    maximum: numeric(schema['maximum']) ?? numeric(schema['exclusiveMaximum']),
    isOpenBelow: schema['exclusiveMinimum'] !== undefined,
    choices,
    parts,
    entryKind: plainEntry || text(entry['entry']) || text(combined['new_entry']),
    isPlainEntry: plainEntry !== '' && !isTarget,
    entryOf: text(combined['entry_of']) || text(combined['new_entry_of']),
    nameKind: text(combined['cell_name']) || label,
    isFreeName: label !== '' || newEntry !== '' || text(combined['entry_of']) !== '',
    namesBeside: Array.isArray(combined['or']) ? combined['or'].map(String) : [],
    examples: Array.isArray(combined['examples']) ? combined['examples'].map(String) : [],
    nameOf: text(combined['of']),
    jointsOf,
    measuredOn: text(combined['measured_on']),
    properties: inner,
    item,
    fallback: key.default,
  }
}

const KEPT_BESIDE = new Set([
  'description',
  'unit',
  'entry',
  'entry_of',
  'new_entry',
  'new_entry_of',
  'cell_name',
  'cell_label',
  'of',
  'or',
  'examples',
  'measured_on',
])

function withoutShape(schema: Schema): Dict<unknown> {
  return Object.fromEntries(Object.entries(schema).filter(([key]) => KEPT_BESIDE.has(key)))
}

interface Resolved {
  readonly schema: Schema
  readonly isNullable: boolean
  readonly jointsOf: string
}

/** Follow references, and take the first alternative that is not `null`; what stands beside it counts too. */
function resolved(schema: Schema, definitions: Schema): Resolved {
  const reference = text(schema['$ref']).replace('#/$defs/', '')
  if (reference) return resolved(record(lookup(definitions, reference)), definitions)
  const options = Array.isArray(schema['anyOf']) ? schema['anyOf'].map(record) : []
  if (options.length === 0) return { schema, isNullable: schema['type'] === 'null', jointsOf: text(schema['joints_of']) }
  const all = options.map((option) => resolved(option, definitions))
  const real = options.flatMap((option, at) => (option['type'] === 'null' ? [] : (all[at]?.schema ?? [])))
  const target = real.find((option) => 'entry' in record(option['properties']))
  const chosen = real.length === 1 ? real[0] : target
  return {
    schema: { ...chosen, ...withoutShape(schema) },
    isNullable: real.length < options.length,
    jointsOf: all.map((each) => each.jointsOf).find(Boolean) ?? '',
  }
}

function kindOf(schema: Schema, is: Dict<boolean>): EditFieldKind {
  if (is['isEntry']) return 'entry'
  if (is['hasChoices']) return 'choice'
  if (is['isVector']) return 'vector'
  if (is['isRecord']) return 'record'
  if (is['isList']) return 'list'
  const type = schema['type']
  if (type === 'number' || type === 'integer' || type === 'boolean') return type
  return type === 'string' ? 'text' : 'data'
}

function partsOf(schema: Schema): readonly string[] {
  const items = Array.isArray(schema['prefixItems']) ? schema['prefixItems'].map(record) : []
  if (schema['type'] !== 'array' || items.length === 0 || items.length > 6) return []
  if (!items.every((item) => item['type'] === 'number' || item['type'] === 'integer')) return []
  if (Array.isArray(schema['parts'])) return schema['parts'].map(String)
  return (items.length > 4 ? ['x', 'y', 'z', 'rx', 'ry', 'rz'] : ['x', 'y', 'z', 'w']).slice(0, items.length)
}

function record(value: unknown): Schema {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Schema) : {}
}

function text(value: unknown): string {
  return typeof value === 'string' ? value : ''
}

function numeric(value: unknown): number | undefined {
  return typeof value === 'number' ? value : undefined
}

/** `0.05 – 1 m/s`, `> 0 s`. */
export function limitsText({ minimum, maximum, isOpenBelow, unit }: EditField): string {
  const range =
    minimum !== undefined && maximum !== undefined
      ? `${minimum} – ${maximum}`
      : minimum !== undefined
        ? `${isOpenBelow ? '>' : '≥'} ${minimum}`
        : maximum !== undefined
          ? `≤ ${maximum}`
          : ''
  return [range, unit].filter(Boolean).join(' ')
}

/** Is it written with `${…}`, and so only known when the node is entered? */
export function isTemplate(value: unknown): boolean {
  return typeof value === 'string' && value.includes('${')
}

/** What is wrong with a value, or nothing; templates are checked by the server. */
export function fieldProblem(field: EditField, value: unknown): string | undefined {
  if (value === undefined) return field.required ? 'A value is required' : undefined
  if (isTemplate(value) || (value === null && field.isNullable)) return undefined
  if (field.kind !== 'number' && field.kind !== 'integer') return undefined
  if (typeof value !== 'number' || !Number.isFinite(value)) return 'This is not a number'
  if (field.kind === 'integer' && !Number.isInteger(value)) return 'This must be a whole number'
  const { minimum, maximum, isOpenBelow } = field
  const isLow = minimum !== undefined && (isOpenBelow ? value <= minimum : value < minimum)
  return isLow || (maximum !== undefined && value > maximum) ? `Must be ${limitsText(field)}` : undefined
}

/** A value as one line of text to be edited. */
export function shownValue(value: unknown): string {
  if (value === undefined || value === null) return ''
  return typeof value === 'string' ? value : JSON.stringify(value)
}

/** What typed text means for a field: numbers, data in JSON, everything else as it is; empty text is no value. */
export function typedValue(field: Pick<EditField, 'kind'>, typed: string): unknown {
  const trimmed = typed.trim()
  if (trimmed === '') return undefined
  if (isTemplate(trimmed) || field.kind === 'text' || field.kind === 'choice') return trimmed
  return looseValue(trimmed)
}

/** Text as the plain value it looks like: a number, true, JSON, a list or mapping as in YAML; else text. */
export function looseValue(typed: string): unknown {
  try {
    return JSON.parse(typed) as unknown
  } catch {
    return /^\s*[[{]/.test(typed) ? flowValue(typed) : typed
  }
}

const TOKEN = /"(?:[^"\\]|\\.)*"|'[^']*'|\$\{[^}]*\}|[[\]{},:]|[^\s[\]{},:"'](?:[^[\]{},:]*[^\s[\]{},:])?/g

/** A list or mapping whose words need no quotes; the text itself where it is none. */
function flowValue(typed: string): unknown {
  const json = typed.replace(TOKEN, (token) => {
    if (/^["[\]{},:]/.test(token)) return token
    if (/^(true|false|null|-?\d.*)$/.test(token) && isJson(token)) return token
    return JSON.stringify(token.startsWith("'") ? token.slice(1, -1) : token)
  })
  try {
    return JSON.parse(json) as unknown
  } catch {
    return typed
  }
}

/** A value with one of its fields changed; without it where it is given no value, and undefined where nothing is left. */
export function withField(value: Dict<unknown>, name: string, next: unknown): Dict<unknown> | undefined {
  const changed = next === undefined ? without(value, name) : { ...value, [name]: next }
  return Object.keys(changed).length > 0 ? changed : undefined
}

/** From a parameter's JSON Schema to a field of the form: kind, label, range, checks. Pure. */
import { lookup, type Dict } from './dict'
import type { CatalogueBody, ParameterView } from '../api/types'

export type FieldKind = 'number' | 'integer' | 'boolean' | 'text' | 'choice' | 'json'

export interface Field {
  readonly name: string
  readonly kind: FieldKind
  readonly label: string
  readonly description: string
  readonly unit: string
  readonly required: boolean
  readonly minimum: number | undefined
  readonly maximum: number | undefined
  readonly choices: readonly string[]
  /** Kind of thing of the cell that it names, or of an entry of the store; empty for none. */
  readonly nameKind: string
  readonly entryKind: string
  /** Names that always fit beside those of the cell. */
  readonly namesBeside: readonly string[]
  readonly initial: unknown
}

/** Describe one parameter as a form field. */
export function fieldOf(parameter: ParameterView): Field {
  const { schema } = parameter
  const choices = Array.isArray(schema['enum']) ? schema['enum'].map(String) : []
  const kind = choices.length > 0 ? 'choice' : kindOf(schema['type'])
  return {
    name: parameter.name,
    kind,
    label: text(schema['title']) || parameter.name,
    description: text(schema['description']),
    unit: text(schema['unit']),
    required: parameter.required,
    minimum: numeric(schema['minimum']) ?? numeric(schema['exclusiveMinimum']),
    maximum: numeric(schema['maximum']) ?? numeric(schema['exclusiveMaximum']),
    choices,
    nameKind: text(schema['cell_name']) || text(schema['cell_label']),
    entryKind: text(schema['entry']),
    namesBeside: Array.isArray(schema['or']) ? schema['or'].map(String) : [],
    initial: shownValue(kind, schema['default']),
  }
}

function kindOf(type: unknown): FieldKind {
  const first: unknown = Array.isArray(type) ? type.find((t) => t !== 'null') : type
  switch (first) {
    case 'number':
    case 'integer':
    case 'boolean':
      return first
    case 'string':
      return 'text'
    default:
      return 'json'
  }
}

/** A value as its field of the form shows it. */
export function shownValue(kind: FieldKind, value: unknown): unknown {
  if (kind === 'json') return value === undefined ? '' : JSON.stringify(value, null, 1)
  if (kind === 'boolean') return value === true
  return value ?? ''
}

function text(value: unknown): string {
  return typeof value === 'string' ? value : ''
}

function numeric(value: unknown): number | undefined {
  return typeof value === 'number' ? value : undefined
}

/** What there is to choose from; undefined where the field names nothing, or nothing of that kind is known. */
export function offersFor(field: Field, cell: Pick<CatalogueBody, 'names' | 'entries'> | undefined): readonly string[] | undefined {
  if (!cell || (!field.nameKind && !field.entryKind)) return undefined
  if (field.entryKind) return cell.entries.filter((entry) => entry.kind === field.entryKind).map((entry) => entry.name)
  const known = lookup(cell.names, field.nameKind)
  return known && [...new Set([...field.namesBeside, ...known])]
}

/** The allowed range in words, `0.05 – 1`, `≥ 1`; empty without limits. */
export function rangeText(field: Field): string {
  const { minimum, maximum } = field
  if (minimum !== undefined && maximum !== undefined) return `${minimum} – ${maximum}`
  if (minimum !== undefined) return `≥ ${minimum}`
  return maximum !== undefined ? `≤ ${maximum}` : ''
}

/** What is wrong with a value, or nothing; the engine checks again. */
export function problemWith(field: Field, value: unknown): string | undefined {
  const empty = value === '' || value === undefined || value === null
  if (empty) return field.required ? 'A value is required' : undefined
  if (field.kind === 'json') return typeof value === 'string' && isJson(value) ? undefined : 'This is not JSON'
  if (field.kind !== 'number' && field.kind !== 'integer') return undefined
  const number = Number(value)
  if (!Number.isFinite(number)) return 'This is not a number'
  if (field.kind === 'integer' && !Number.isInteger(number)) return 'This must be a whole number'
  const tooLow = field.minimum !== undefined && number < field.minimum
  const tooHigh = field.maximum !== undefined && number > field.maximum
  return tooLow || tooHigh ? `Must be ${rangeText(field)}` : undefined
}

/** Is it JSON? */
export function isJson(value: string): boolean {
  try {
    JSON.parse(value)
    return true
  } catch {
    return false
  }
}

/** The userdata to begin with, written as a JSON object; undefined where it is none. */
export function inputsOf(written: string): Dict<unknown> | undefined {
  if (written.trim() === '') return {}
  const value: unknown = isJson(written) ? JSON.parse(written) : undefined
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Dict<unknown>) : undefined
}

/** The same as it is written; empty where there is none. */
export function inputsText(inputs: Dict<unknown>): string {
  return Object.keys(inputs).length > 0 ? JSON.stringify(inputs, null, 1) : ''
}

/** The parameters to send; fields left empty are left out, so that the document's default holds. */
export function parametersOf(fields: readonly Field[], values: Dict<unknown>): Dict<unknown> {
  const filled = fields.filter((field) => lookup(values, field.name) !== '' && lookup(values, field.name) !== undefined)
  return Object.fromEntries(filled.map((field) => [field.name, valueOf(field, lookup(values, field.name))]))
}

function valueOf(field: Field, value: unknown): unknown {
  if (field.kind === 'number' || field.kind === 'integer') return Number(value)
  return field.kind === 'json' ? (JSON.parse(String(value)) as unknown) : value
}

/** From the JSON Schema of a request, message or value to the fields of a form. Pure. */
import { lookup, type Dict } from './dict'
import { fieldOf, type Field } from './schema'

type Schema = Dict<unknown>

/** The fields of a request; empty for one that takes nothing. */
export function requestFields(schema: Schema): readonly Field[] {
  const definitions = record(schema['$defs'])
  const root = resolved(schema, definitions)
  const required = Array.isArray(root['required']) ? root['required'].map(String) : []
  return Object.entries(record(root['properties'])).map(([name, property]) =>
    fieldWithin(name, record(property), definitions, required.includes(name)),
  )
}

/** The one field of a value that is set as a whole; `now` is what it is at present. */
export function valueField(name: string, schema: Schema, now: unknown): Field {
  return fieldWithin(name, { ...schema, default: now }, record(schema['$defs']), true)
}

function fieldWithin(name: string, property: Schema, definitions: Schema, required: boolean): Field {
  // The title of a shared shape is the name of its type, not of this field.
  const flat: Schema = { ...resolved(property, definitions), title: property['title'] }
  const schema = property['default'] !== undefined && property['default'] !== null ? { ...flat, default: property['default'] } : flat
  const field = fieldOf({ name, schema, required })
  if (field.kind !== 'json') return field
  const initial = schema['default'] ?? (required ? example(flat, definitions) : undefined)
  return { ...field, initial: initial === undefined ? '' : JSON.stringify(initial) }
}

/** Follow a reference, and take the first alternative that is not `null`; what stands beside it counts too. */
function resolved(schema: Schema, definitions: Schema): Schema {
  const { $ref: reference, anyOf: options, ...beside } = schema
  if (typeof reference === 'string') {
    const target = resolved(record(lookup(definitions, reference.replace('#/$defs/', ''))), definitions)
    return { ...target, ...beside }
  }
  const first = Array.isArray(options) ? options.map(record).find((option) => option['type'] !== 'null') : undefined
  return first ? { ...resolved(first, definitions), ...beside } : schema
}

/** The simplest value of a shape, to be filled in: zeros, empty texts, first choices. */
function example(schema: Schema, definitions: Schema, depth = 0): unknown {
  const flat = resolved(schema, definitions)
  if (flat['default'] !== undefined) return flat['default']
  const choices = flat['enum']
  if (Array.isArray(choices)) return choices[0] as unknown
  if (depth > 6) return null
  switch (flat['type']) {
    case 'object':
      return exampleObject(flat, definitions, depth)
    case 'array':
      return Array.isArray(flat['prefixItems']) ? flat['prefixItems'].map((item) => example(record(item), definitions, depth + 1)) : []
    case 'number':
    case 'integer':
      return typeof flat['minimum'] === 'number' ? flat['minimum'] : 0
    case 'boolean':
      return false
    case 'string':
      return ''
    default:
      return null
  }
}

function exampleObject(schema: Schema, definitions: Schema, depth: number): Dict<unknown> {
  const required = Array.isArray(schema['required']) ? schema['required'].map(String) : []
  const shown = Object.entries(record(schema['properties'])).filter(([name]) => required.includes(name))
  return Object.fromEntries(shown.map(([name, part]) => [name, example(record(part), definitions, depth + 1)]))
}

function record(value: unknown): Schema {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Schema) : {}
}

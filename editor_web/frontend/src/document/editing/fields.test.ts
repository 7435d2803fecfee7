/** From JSON Schema to fields. */
import { expect, it } from 'vitest'
import { editFieldOf, fieldProblem, limitsText, looseValue, typedValue, withField } from './fields'

const key = (schema: Record<string, unknown>, more = {}) => editFieldOf({ name: 'x', required: false, default: null, schema, ...more })

it('knows numbers with limits and unit, also where none is allowed', () => {
  const field = key({
    anyOf: [{ description: 'Travel time', unit: 's', type: 'number', exclusiveMinimum: 0 }, { type: 'null' }],
  })
  expect(field).toMatchObject({ kind: 'number', unit: 's', description: 'Travel time', isNullable: true, minimum: 0 })
  expect(limitsText(field)).toBe('> 0 s')
  expect([fieldProblem(field, 0), fieldProblem(field, 1), fieldProblem(field, '${t}'), fieldProblem(field, null)]).toEqual([
    'Must be > 0 s',
    undefined,
    undefined,
    undefined,
  ])
})

it('knows vectors, choices, and targets that are named entries', () => {
  const number = { type: 'number' }
  expect(key({ type: 'array', prefixItems: [number, number, number], unit: 'm' })).toMatchObject({
    kind: 'vector',
    parts: ['x', 'y', 'z'],
    unit: 'm',
  })
  expect(key({ enum: ['a', 'b'] })).toMatchObject({ kind: 'choice', choices: ['a', 'b'] })
  const target = {
    $defs: { Target: { type: 'object', properties: { entry: { type: 'string', entry: 'pose' } } } },
    description: 'Where',
    anyOf: [{ $ref: '#/$defs/Target' }, { type: 'null' }],
  }
  expect(key(target)).toMatchObject({ kind: 'entry', entryKind: 'pose', isPlainEntry: false, description: 'Where' })
  expect(key({ type: 'string', entry: 'dmp' })).toMatchObject({ kind: 'entry', entryKind: 'dmp', isPlainEntry: true })
})

it('knows the fields of a value, and of a target those beside its entry', () => {
  const target = {
    $defs: {
      Target: {
        type: 'object',
        properties: {
          entry: { type: 'string', entry: 'pose' },
          frame: { type: 'string', cell_name: 'frame', or: ['part'], default: 'world' },
        },
      },
    },
    anyOf: [{ $ref: '#/$defs/Target' }, { type: 'array', items: { type: 'number' }, joints_of: 'robot' }],
  }
  const field = key(target)
  expect(field).toMatchObject({ kind: 'entry', jointsOf: 'robot' })
  expect(field.properties).toMatchObject([{ name: 'frame', nameKind: 'frame', namesBeside: ['part'], fallback: 'world', required: false }])
  const low = { type: 'array', prefixItems: [{ type: 'number' }, { type: 'number' }], parts: ['low', 'high'] }
  const region = key({ type: 'object', required: ['height_m'], properties: { height_m: low } })
  expect(region).toMatchObject({ kind: 'record', properties: [{ kind: 'vector', parts: ['low', 'high'], required: true }] })
})

it('changes one field of a value, and leaves nothing where none is left', () => {
  expect(withField({ a: 1, b: 2 }, 'a', undefined)).toEqual({ b: 2 })
  expect(withField({ a: 1 }, 'b', 2)).toEqual({ a: 1, b: 2 })
  expect(withField({ a: 1 }, 'a', undefined)).toBeUndefined()
})

it('asks for a value where one is required', () => {
  expect(fieldProblem(key({ type: 'string' }, { required: true }), undefined)).toBe('A value is required')
})

it.each([
  ['number', '0.5', 0.5],
  ['number', '${speed}', '${speed}'],
  ['text', '12', '12'],
  ['data', '[1, 2]', [1, 2]],
  ['number', ' ', undefined],
] as const)('takes for a %s what is typed as %s', (kind, typed, value) => {
  expect(typedValue({ kind }, typed)).toEqual(value)
})

it('takes lists and mappings as they stand in the file', () => {
  expect(looseValue('{center_m: [-0.09, -0.28], size_m: [1e-1, 2]}')).toEqual({
    center_m: [-0.09, -0.28],
    size_m: [0.1, 2],
  })
  expect(looseValue('{entry: left_pick, note: "a, b", of: \'c: d\', at: "x"}')).toEqual({
    entry: 'left_pick',
    note: 'a, b',
    of: 'c: d',
    at: 'x',
  })
  expect(looseValue('[true, null, "1", two words, ${a.b}, 007]')).toEqual([true, null, '1', 'two words', '${a.b}', '007'])
  expect(looseValue('{not closed')).toBe('{not closed')
  expect(looseValue('left_pick')).toBe('left_pick')
})

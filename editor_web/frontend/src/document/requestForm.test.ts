/** Forms of requests. */
import { expect, test } from 'vitest'
import { requestFields, valueField } from './requestForm'

const POSE = {
  type: 'object',
  required: ['xyz'],
  properties: {
    xyz: { type: 'array', prefixItems: [{ type: 'number' }, { type: 'number' }, { type: 'number' }], items: false },
    frame: { type: 'string', default: 'world' },
  },
}
const MOVE = {
  $ref: '#/$defs/Move',
  $defs: {
    Pose: POSE,
    Move: {
      type: 'object',
      required: ['target', 'speed'],
      properties: {
        target: { $ref: '#/$defs/Pose' },
        speed: { type: 'number', exclusiveMinimum: 0, maximum: 1, unit: 'm/s', description: 'How fast' },
        name: { anyOf: [{ type: 'string' }, { type: 'null' }], default: null },
        mode: { enum: ['stiff', 'soft'], default: 'soft' },
        via: { type: 'array', items: { $ref: '#/$defs/Pose' }, default: [] },
      },
    },
  },
}

test('every property is a field of its kind', () => {
  const fields = requestFields(MOVE)
  expect(fields.map(({ name, kind, required, initial }) => [name, kind, required, initial])).toEqual([
    ['target', 'json', true, '{"xyz":[0,0,0]}'],
    ['speed', 'number', true, ''],
    ['name', 'text', false, ''],
    ['mode', 'choice', false, 'soft'],
    ['via', 'json', false, '[]'],
  ])
  expect(fields[1]).toMatchObject({ unit: 'm/s', maximum: 1, description: 'How fast' })
})

test('a request that takes nothing has no fields', () => {
  expect(requestFields({ $ref: '#/$defs/Reset', $defs: { Reset: { type: 'object', properties: {}, required: [] } } })).toEqual([])
  expect(requestFields({})).toEqual([])
})

test('a value is one field that begins with what it is now', () => {
  expect(valueField('left/gain', { type: 'number', minimum: 0 }, 0.5)).toMatchObject({ kind: 'number', initial: 0.5, minimum: 0 })
  expect(valueField('left/pose', { $ref: '#/$defs/Pose', $defs: { Pose: POSE } }, { xyz: [1, 2, 3] })).toMatchObject({
    kind: 'json',
    initial: '{"xyz":[1,2,3]}',
  })
})

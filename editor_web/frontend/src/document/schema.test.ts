/** Forms: from JSON Schema to fields, checks and the parameters that are sent. */
import { describe, expect, it } from 'vitest'
import { fieldOf, inputsOf, inputsText, parametersOf, problemWith, rangeText, shownValue } from './schema'

const field = (schema: Record<string, unknown>, required = false) => fieldOf({ name: 'p', schema, required })

describe('fieldOf', () => {
  it('reads label, unit, range and default', () => {
    const speed = field({ type: 'number', title: 'Speed', unit: 'm/s', minimum: 0.1, maximum: 2, default: 0.5 })
    expect(speed).toMatchObject({ kind: 'number', label: 'Speed', unit: 'm/s', initial: 0.5 })
    expect(rangeText(speed)).toBe('0.1 – 2')
  })

  it('offers the values of an enum as choices', () => {
    expect(field({ enum: ['a', 'b'] })).toMatchObject({ kind: 'choice', choices: ['a', 'b'] })
  })

  it('falls back to JSON for structures', () => {
    expect(field({ type: 'object', default: { x: 1 } })).toMatchObject({ kind: 'json', initial: '{\n "x": 1\n}' })
  })
})

it('shows what a run was started with so that the form sends the same again', () => {
  const fields = [
    fieldOf({ name: 'n', schema: { type: 'number' }, required: false }),
    fieldOf({ name: 'o', schema: { type: 'object' }, required: false }),
  ]
  const started = { n: 0.25, o: { x: [1, 2] } }
  const values = Object.fromEntries(fields.map(({ name, kind }) => [name, shownValue(kind, started[name as 'n' | 'o'])]))
  expect(parametersOf(fields, values)).toEqual(started)
})

it('reads the userdata to begin with, and writes it the same', () => {
  expect(inputsOf(inputsText({ count: 3 }))).toEqual({ count: 3 })
  expect(inputsOf(inputsText({}))).toEqual({})
  expect(['[1]', '3', 'null', '{'].map(inputsOf)).toEqual([undefined, undefined, undefined, undefined])
})

describe('problemWith', () => {
  it.each([
    [{ type: 'number', minimum: 0, maximum: 1 }, 2, 'Must be 0 – 1'],
    [{ type: 'integer' }, 1.5, 'This must be a whole number'],
    [{ type: 'number' }, 'abc', 'This is not a number'],
    [{ type: 'object' }, '{', 'This is not JSON'],
    [{ type: 'number', minimum: 0 }, 0, undefined],
  ])('says what is wrong: %j with %j', (schema, value, problem) => {
    expect(problemWith(field(schema), value)).toBe(problem)
  })

  it('asks for a required value only', () => {
    expect(problemWith(field({ type: 'string' }, true), '')).toBe('A value is required')
    expect(problemWith(field({ type: 'string' }), '')).toBeUndefined()
  })
})

describe('parametersOf', () => {
  it('sends numbers as numbers, and leaves empty fields to the defaults of the document', () => {
    const fields = [
      fieldOf({ name: 'speed', schema: { type: 'number' }, required: false }),
      fieldOf({ name: 'part', schema: { type: 'string' }, required: false }),
      fieldOf({ name: 'at', schema: { type: 'array' }, required: false }),
    ]
    expect(parametersOf(fields, { speed: '0.5', part: '', at: '[1, 2]' })).toEqual({ speed: 0.5, at: [1, 2] })
  })
})

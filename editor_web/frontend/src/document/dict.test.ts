/** Names that every object inherits are names like all others. */
import { describe, expect, it } from 'vitest'
import { lookup, without, type Dict } from './dict'
import { withChild } from './editing/rules'
import { EMPTY, fold } from './live'
import { fieldOf, parametersOf, problemWith } from './schema'
import { withChanges } from './userdata'

const NAMES = ['__proto__', 'constructor', 'toString', 'hasOwnProperty', 'valueOf', '__defineGetter__']

describe.each(NAMES)('a dictionary with names like %s', (name) => {
  it('has only what was put into it', () => {
    const empty: Dict<number> = {}
    const full: Dict<number> = { ...empty, [name]: 1 }
    const parsed = JSON.parse(`{"${name}": 2}`) as Dict<number>
    expect([lookup(empty, name), lookup(full, name), lookup(parsed, name)]).toEqual([undefined, 1, 2])
    expect(lookup(without(full, name), name)).toBeUndefined()
    expect(Object.getPrototypeOf({ ...parsed, other: 1 })).toBe(Object.prototype)
  })

  it('is what forms, runs and documents are kept in', () => {
    const field = fieldOf({ name, schema: { type: 'number', default: 3 }, required: true })
    expect(problemWith(field, lookup({}, name))).toBe('A value is required')
    expect(Object.entries(parametersOf([field], { [name]: '4' }))).toEqual([[name, 4]])
    const scope = { is_open: true, since_s: 0, values: {} }
    expect(Object.keys(withChanges({}, { [name]: scope }, false))).toEqual([name])
    const changed = fold(EMPTY, { k: 'documents', changed: { [name]: 'hash' } }, 0)
    expect(changed !== 'gap' && lookup(changed.documents, name)).toBe('hash')
    const rule = { outcome: 'done', when: { other: 'a' }, at_least: null, preempt: [] }
    expect(withChild([rule], 0, name, 'b')).toEqual([{ ...rule, when: { other: 'a', [name]: 'b' } }])
    expect(withChild([rule], 0, name, '')).toEqual([rule])
  })
})

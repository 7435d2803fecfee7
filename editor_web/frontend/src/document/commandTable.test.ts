/** The table of commands: one meaning for a key on each page, changes of it, and what can be no key. */
import { describe, expect, it } from 'vitest'
import { chordOf, chordText } from './chord'
import { chordsOf, COMMAND_TABLE, conflictOf, readOwnKeys, refusalOf, withKeys } from './commandTable'

const PLAIN = { ctrlKey: false, metaKey: false, altKey: false, shiftKey: false }

describe('the table', () => {
  it('has each command once, and a key means one thing on a page', () => {
    expect(new Set(COMMAND_TABLE.map((row) => row.id)).size).toBe(COMMAND_TABLE.length)
    for (const row of COMMAND_TABLE) {
      for (const chord of row.chords) expect([row.id, conflictOf(row.id, chord, {})?.id]).toEqual([row.id, undefined])
    }
  })

  it('reads the keys as they are written', () => {
    expect(chordsOf('redo', {}).map(chordText)).toEqual(['Ctrl+Shift+Z', 'Ctrl+Y'])
    expect(chordsOf('zoom-in', {}).map(chordText)).toEqual(['+', '='])
    expect(chordsOf('left', {}).map(chordText)).toEqual(['Alt+←'])
  })
})

describe('a changed key', () => {
  it('stands for those in the table', () => {
    expect(chordsOf('save', { save: [{ key: 'F4' }] }).map(chordText)).toEqual(['F4'])
    expect(chordsOf('save', { save: [] })).toEqual([])
  })

  it('conflicts on the same page and with the keys of every page, but not between a run and the editor', () => {
    expect(conflictOf('pause', { key: 'i' }, {})?.id).toBe('into')
    expect(conflictOf('pause', { key: 'k', ctrl: true }, {})?.id).toBe('search')
    expect(conflictOf('search', { key: 'F8' }, {})?.id).toBe('problem')
    expect(conflictOf('pause', { key: 'F8' }, {})).toBeUndefined()
    expect(conflictOf('pause', { key: 'i' }, { into: [{ key: 'F7' }] })).toBeUndefined()
    expect(conflictOf('pause', { key: 'F7' }, { into: [{ key: 'F7' }] })?.id).toBe('into')
  })

  it('is taken from whoever has it, also where a key is set back', () => {
    const moved = withKeys({}, 'pause', [{ key: 'i' }])
    expect(moved).toEqual({ pause: [{ key: 'i' }], into: [] })
    expect(withKeys(moved, 'into', undefined)).toEqual({ pause: [] })
    expect(withKeys({}, 'search', [{ key: 'i' }])).toEqual({ search: [{ key: 'i' }], into: [], initial: [] })
  })

  it('cannot be the key that stops the cell, nor one of the browser, nor one that moves about', () => {
    expect(refusalOf({ key: 'Backspace', ctrl: true, shift: true })).toContain('stops the cell')
    expect(refusalOf({ key: 'w', ctrl: true })).toContain('browser')
    expect(refusalOf({ key: 'Tab' })).toContain('moves')
    expect(refusalOf({ key: 'Enter', ctrl: true })).toBeUndefined()
    expect(refusalOf({ key: 'q' })).toBeUndefined()
  })

  it('is read from what was kept as far as it is one', () => {
    const chord = { key: 'q', ctrl: true }
    expect(readOwnKeys({ save: [chord], gone: [chord], undo: 'q', redo: [{ key: 3 }], copy: [] })).toEqual({ save: [chord], copy: [] })
    expect(readOwnKeys('nonsense')).toEqual({})
  })
})

it('takes a press for the chord that it is', () => {
  expect(chordOf({ ...PLAIN, key: 'Shift', shiftKey: true })).toBeUndefined()
  expect(chordOf({ ...PLAIN, key: 'S', shiftKey: true })).toEqual({ key: 's', shift: true })
  expect(chordOf({ ...PLAIN, key: '?', shiftKey: true })).toEqual({ key: '?' })
  expect(chordOf({ ...PLAIN, key: 'F5', shiftKey: true, metaKey: true })).toEqual({ key: 'F5', shift: true, ctrl: true })
})

/** Names in `${…}`, keys of the keyboard, neighbours, rules, places in the text. */
import { expect, it } from 'vitest'
import type { Box } from '../geometry'
import { completed, openingAt } from './completion'
import { chordText, isChord } from '../chord'
import { aligned, neighborOf } from './neighbors'
import { nodeAtLine, stateNear, writingAt } from './textPositions'
import { added, conditionsOf, consequenceOf, withChild, withCount, withPreempted } from './rules'
import { machineNode, node } from './testNodes'

const NAMES = ['speed', 'line_speed', 'part'].map((name) => ({ name, origin: 'parameter', detail: '' }))

it('offers names inside of braces only, and closes them', () => {
  expect(openingAt('speed', 5, NAMES)).toBeUndefined()
  expect(openingAt('${speed} x', 10, NAMES)).toBeUndefined()
  const opening = openingAt('${2 * sp', 8, NAMES)
  expect(opening?.names.map((name) => name.name)).toEqual(['speed', 'line_speed'])
  expect(opening && completed('${2 * sp', 8, opening, 'speed')).toEqual({ text: '${2 * speed}', cursor: 12 })
  expect(opening && completed('${2 * sp}', 8, opening, 'speed')).toEqual({ text: '${2 * speed}', cursor: 11 })
})

const press = (key: string, more = {}) => ({
  key,
  ctrlKey: false,
  metaKey: false,
  altKey: false,
  shiftKey: false,
  ...more,
})

it('tells chords apart by Ctrl, Alt and Shift', () => {
  expect(isChord(press('z', { ctrlKey: true }), { key: 'z', ctrl: true })).toBe(true)
  expect(isChord(press('Z', { ctrlKey: true, shiftKey: true }), { key: 'z', ctrl: true })).toBe(false)
  expect(isChord(press('Z', { metaKey: true, shiftKey: true }), { key: 'z', ctrl: true, shift: true })).toBe(true)
  expect(isChord(press('?', { shiftKey: true }), { key: '?' })).toBe(true)
  expect(chordText({ key: 'ArrowLeft', alt: true })).toBe('Alt+←')
})

const box = (x: number, y: number): Box => ({ x, y, width: 100, height: 50 })

it('goes to the nearest box in a direction', () => {
  const boxes = new Map([
    ['a', box(0, 0)],
    ['b', box(200, 10)],
    ['c', box(400, 0)],
    ['d', box(0, 200)],
  ])
  expect(neighborOf(boxes, 'a', 'ArrowRight')).toBe('b')
  expect(neighborOf(boxes, 'a', 'ArrowDown')).toBe('d')
  expect(neighborOf(boxes, 'a', 'ArrowLeft')).toBeUndefined()
})

it('puts boxes in line without one on the other', () => {
  const row = aligned(
    new Map([
      ['a', box(0, 0)],
      ['b', box(20, 90)],
    ]),
    'row',
  )
  expect(row.get('a')).toEqual({ x: 0, y: 0 })
  expect(row.get('b')?.y).toBe(0)
  expect(row.get('b')?.x).toBeGreaterThan(100)
  expect(
    aligned(
      new Map([
        ['a', box(5, 0)],
        ['b', box(20, 90)],
      ]),
      'left',
    ).get('b'),
  ).toEqual({ x: 5, y: 90 })
})

it('proposes the rules that are missing, and writes them as documents do', () => {
  const children = [node('root/l', ['done', 'failed']), node('root/r', ['done'])]
  const first = added([], children)
  expect(conditionsOf(first)).toEqual([{ finished: { l: 'done', r: 'done' } }])
  expect(conditionsOf(added(first, children)).at(-1)).toEqual({ failed: { l: 'failed' } })
  expect(withChild(first, 0, 'r', '')).toEqual([{ outcome: 'finished', when: { l: 'done' }, at_least: null, preempt: [] }])
  expect(withChild([{ outcome: 'x', when: { l: 'done' }, at_least: null, preempt: [] }], 0, 'l', '')).toEqual([
    { outcome: 'x', when: { l: 'done' }, at_least: null, preempt: [] },
  ])
  const one = withCount(first, 0, 1)
  expect(conditionsOf(one)).toEqual([{ finished: { l: 'done', r: 'done', at_least: 1 } }])
  expect(conditionsOf(withChild(one, 0, 'r', ''))).toEqual([{ finished: { l: 'done' } }])
  expect(conditionsOf(withCount(one, 0, 2))).toEqual(conditionsOf(first))
})

it('writes whom a rule preempts, and gives it an outcome again when it preempts nobody', () => {
  const children = [node('root/l', ['done', 'failed']), node('root/r', ['done'])]
  const some = withPreempted(added([], children), 0, 'r', true)
  expect(conditionsOf(some)).toEqual([{ preempt: ['r'], when: { l: 'done', r: 'done' } }])
  expect(some.map(consequenceOf)).toEqual(['preempt r'])
  const more = withPreempted(withCount(some, 0, 1), 0, 'l', true)
  expect(conditionsOf(more)).toEqual([{ preempt: ['r', 'l'], when: { l: 'done', r: 'done', at_least: 1 } }])
  expect(conditionsOf(withPreempted(some, 0, 'r', false))).toEqual([{ failed: { l: 'done', r: 'done' } }])
  expect(conditionsOf(added(some, children)).at(-1)).toEqual({ finished: { l: 'done', r: 'done' } })
})

it('finds the node of a line, and what is written at a place', () => {
  const root = machineNode('root', 'a', [node('root/a', [], { line: 4, end_line: 6 }), node('root/b', [], { line: 7, end_line: 8 })], [])
  expect(nodeAtLine({ ...root, line: 1, end_line: 9 }, 7)?.path).toBe('root/b')
  const text = 'states:\n  a:\n    state: motion.MoveJoints\n    with:\n      ro'
  expect(writingAt(text, text.length)).toMatchObject({ key: '', word: 'ro', around: ['with', 'a', 'states'] })
  expect(stateNear(text, text.length)).toBe('motion.MoveJoints')
  const flow = '  a: {state: flow.Wait, with: {dur'
  expect(writingAt(flow, flow.length)).toMatchObject({ key: '', word: 'dur' })
  expect(writingAt(flow, flow.length).around[0]).toBe('with')
  const value = '    state: mo'
  expect(writingAt(value, value.length)).toMatchObject({ key: 'state', word: 'mo' })
})

/** Undo and redo. */
import { expect, it } from 'vitest'
import { canRedo, canUndo, newHistory, presentOf, pushed, redone, settled, undone } from './history'
import type { Draft } from './model'

const draft = (text: string): Draft => ({
  text,
  root: undefined,
  hash: '',
  findings: [],
  isChecked: true,
  targets: [],
  areTargetsKnown: true,
  isStale: false,
  document: undefined,
})

it('leads back through every text and forth again, to the very same ones', () => {
  let history = newHistory(draft('a'))
  for (const text of ['b', 'c', 'd']) history = pushed(history, text, draft(text))
  const back = [history, undone(history), undone(undone(history)), undone(undone(undone(history)))]
  expect(back.map((each) => presentOf(each).draft.text)).toEqual(['d', 'c', 'b', 'a'])
  expect(canUndo(undone(undone(undone(history))))).toBe(false)
  expect(presentOf(redone(undone(history))).draft).toBe(presentOf(history).draft)
})

it('forgets what was undone when something else is done', () => {
  const history = pushed(undone(pushed(newHistory(draft('a')), 'b', draft('b'))), 'c', draft('c'))
  expect(canRedo(history)).toBe(false)
  expect(presentOf(undone(history)).draft.text).toBe('a')
})

it('takes a burst of typing as one step, and the next burst as another', () => {
  let history = pushed(newHistory(draft('a')), 'Type', draft('ab'), 'typing')
  history = pushed(history, 'Type', draft('abc'), 'typing')
  history = pushed(settled(history), 'Type', draft('abcd'), 'typing')
  expect(presentOf(undone(history)).draft.text).toBe('abc')
  expect(presentOf(undone(undone(history))).draft.text).toBe('a')
})

it('makes no step of a change that changes nothing', () => {
  expect(canUndo(pushed(newHistory(draft('a')), 'nothing', draft('a')))).toBe(false)
})

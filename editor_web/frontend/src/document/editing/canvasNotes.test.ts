/** Free notes: where they are, what changes them, and how their text is broken into lines. */
import { expect, test } from 'vitest'
import { arrange } from './arrange'
import {
  linesOf,
  movedNote,
  newNote,
  noteId,
  noteBoxes,
  placeForNote,
  resizedNote,
  setCanvasNote,
  spokenNote,
  type CanvasNote,
} from './canvasNotes'
import { areOfLayout, withLayout } from './layoutEdits'
import { nodeOf } from './model'
import { machineNode, node } from './testNodes'

const NOTE: CanvasNote = { text: 'Mind the gap', position: [40, -120], size: [200, 90], colour: 'blue' }
const inner = (notes: Readonly<Record<string, CanvasNote>>) => ({
  ...machineNode('root/inner', 'one', [node('root/inner/one', ['done'])], []),
  canvas_notes: notes,
})
const withNotes = (notes: Readonly<Record<string, CanvasNote>>) => machineNode('root', 'inner', [inner(notes)], [])
const options = { isOpen: () => true, declared: () => [], rowLimit: 2000, call: () => Promise.reject(new Error('the engine was called')) }

test('an open container has room for its notes, also above what is in it, and its nodes stay together', async () => {
  const bare = await arrange(withNotes({}), options)
  const noted = await arrange(withNotes({ n1: NOTE }), options)
  const box = noted.boxes.get(noteId({ path: 'root/inner', name: 'n1' }))
  const [frame, before] = [noted.boxes.get('root/inner'), bare.boxes.get('root/inner')]
  const [one, was] = [noted.boxes.get('root/inner/one'), bare.boxes.get('root/inner/one')]
  if (!box || !frame || !before || !one || !was) throw new Error('not drawn')
  expect(box.y).toBe((noted.origins.get('root/inner')?.y ?? NaN) - 120)
  expect(box.y).toBeGreaterThan(20)
  expect(one.y - was.y).toBe(120)
  expect(frame.height - before.height).toBe(120)
  expect(frame.width).toBeGreaterThanOrEqual(box.x + box.width)
  expect(bare.boxes.size + 1).toBe(noted.boxes.size)
})

test('on the open canvas a note stands where the document says, and is part of what is to be seen', async () => {
  const root = { ...withNotes({}), canvas_notes: { n1: { ...NOTE, position: [-500, 30] as const } } }
  const arrangement = await arrange(root, options)
  const id = noteId({ path: 'root', name: 'n1' })
  expect(arrangement.boxes.get(id)).toEqual({ x: -500, y: 30, width: 200, height: 90 })
  expect(arrangement.outer.has(id)).toBe(true)
})

test('a note is written into the graph at once and taken away, and means nothing to a run', () => {
  const at = { path: 'root/inner', name: 'n1' }
  expect(areOfLayout([setCanvasNote(at, NOTE)])).toBe(true)
  const made = withLayout(withNotes({}), [setCanvasNote(at, NOTE)])
  expect(noteBoxes(nodeOf(made, 'root/inner') ?? made, { x: 1, y: 2 })).toEqual([[noteId(at), { x: 41, y: -118, width: 200, height: 90 }]])
  expect(nodeOf(withLayout(made, [setCanvasNote(at, null)]), 'root/inner')?.canvas_notes).toEqual({})
  expect(withLayout(made, [setCanvasNote({ path: 'root/gone', name: 'n1' }, NOTE)])).toBe(made)
})

test('it is moved and resized by whole pixels, and stays large enough to be seen', () => {
  expect(movedNote(NOTE, { x: 10.4, y: -10 }).position).toEqual([50, -130])
  expect(resizedNote(NOTE, { x: 10, y: -500 }).size).toEqual([210, 40])
})

test('a new one comes where it covers nothing, as near as can be', () => {
  expect(placeForNote({ x: 5, y: 5 }, [])).toEqual({ x: 5, y: 5 })
  const wide = { x: -500, y: 0, width: 1000, height: 100 }
  expect(placeForNote({ x: 0, y: 60 }, [wide])).toEqual({ x: 0, y: 112 })
  expect(placeForNote({ x: 0, y: -10 }, [wide])).toEqual({ x: 0, y: -102 })
  expect(placeForNote({ x: 0, y: 60 }, [wide, { x: 0, y: 120, width: 10, height: 10 }, { ...wide, y: -200 }])).toEqual({ x: 0, y: 142 })
})

test('two people who add one each give them different names, and what it says is spoken', () => {
  const made = newNote('root', { x: 1.4, y: 2 }, () => 0.5)
  expect(made).toMatchObject({ path: 'root', note: { position: [1, 2], text: '' } })
  expect(made.name).toMatch(/^n[0-9a-z]{5}$/)
  expect(newNote('root', { x: 0, y: 0 }, () => 0.4).name).not.toBe(made.name)
  expect(spokenNote({ path: 'root/inner', name: 'n1' }, NOTE)).toBe('Blue note on the canvas of inner: Mind the gap')
})

test('a text is broken between words, at its own line breaks, and inside of a word that is too long', () => {
  expect(linesOf('one two three\nfour', 8)).toEqual(['one two', 'three', 'four'])
  expect(linesOf('abcdefghij kl', 4)).toEqual(['abcd', 'efgh', 'ij', 'kl'])
  expect(linesOf('', 4)).toEqual([''])
})

/** Free notes on the canvas: written, moved, resized, coloured and deleted by keyboard and pointer, each as one edit. */
import { fireEvent, screen, waitFor } from '@testing-library/react'
import { ReactFlow } from '@xyflow/react'
import { beforeEach, expect, it } from 'vitest'
import { live, server, session, show } from '../../../testing/page'
import type { DocumentInfo, DocumentNode, Edit, EditAnswer } from '../../api/types'
import type { CanvasNote } from '../../document/editing/canvasNotes'
import { newHistory } from '../../document/editing/history'
import { withLayout } from '../../document/editing/layoutEdits'
import { machineNode, node } from '../../document/editing/testNodes'
import { draftFrom } from './apply'
import { drawingOf } from './drawing'
import { FreeNoteOverlay } from './FreeNoteOverlay'
import { addFreeNote } from './freeNotes'
import { toggleNotes } from './notes'
import { Picture } from './Picture'
import { OF_PAGE } from './pictureParts'
import { blank, setEditor, useEditor } from './store'

const ID = 'behaviors/shift.yaml'
const EDITS = `POST /documents/${ID}/edits`
const INFO = { name: 'shift', description: '', cell: null, parameters: {}, userdata: {}, outcomes: [], success: [] } as DocumentInfo
const NOTE: CanvasNote = { text: 'Mind the gap', position: [40, 30], size: [200, 90], colour: 'blue' }
const AT = { edit: 'set_canvas_note', path: 'root', name: 'n1' } as const
const ROOT: DocumentNode = { ...machineNode('root', 'grasp', [node('root/grasp', ['held'])], []), canvas_notes: { n1: NOTE } }

function edits(): Edit[] {
  return (server().bodies(EDITS) as { edits: Edit[] }[]).flatMap((body) => body.edits)
}

let written = ROOT

/** The server applies what it was asked for last. */
function answer(): EditAnswer {
  written = withLayout(written, edits().slice(-1))
  const text = `${edits().length}`
  return { hash: text, graph: written, document: INFO, findings: [], checked: true, text, changed: [], refused: null, difference: null }
}

beforeEach(() => {
  written = ROOT
  server()
    .on('GET /session', session())
    .on(EDITS, answer)
    .on(`POST /documents/${ID}/targets`, { findings: [], dropped: false, problem: '' })
  live()
  useEditor.setState(blank(ID), true)
  const draft = draftFrom({ hash: 'h1', graph: ROOT, findings: [], checked: true, document: INFO }, 'one', undefined)
  setEditor({ phase: 'ready', base: { text: 'one', hash: 'h1' }, history: newHistory(draft) })
})

function shown() {
  return show(
    <ReactFlow>
      <FreeNoteOverlay />
    </ReactFlow>,
  )
}

const paper = () => screen.findByRole('button', { name: 'Blue note on the canvas of the behavior: Mind the gap' })

it('is moved, resized and deleted by keys', async () => {
  const user = shown()
  ;(await paper()).focus()
  await user.keyboard('{ArrowRight}')
  await waitFor(() => expect(edits().at(-1)).toEqual({ ...AT, note: { ...NOTE, position: [50, 30] } }))
  await user.keyboard('{Shift>}{ArrowDown}{/Shift}')
  await waitFor(() => expect(edits().at(-1)).toEqual({ ...AT, note: { ...NOTE, position: [50, 30], size: [200, 100] } }))
  await user.keyboard('{Delete}')
  await waitFor(() => expect(edits().at(-1)).toEqual({ ...AT, note: null }))
  expect(screen.queryByRole('button', { name: /note on the canvas/ })).toBeNull()
})

it('is written by Enter, taken by Ctrl+Enter and left as it was by Escape', async () => {
  const user = shown()
  ;(await paper()).focus()
  await user.keyboard('{Enter}')
  await user.type(await screen.findByRole('textbox', { name: 'Text of the note' }), ' here{Escape}')
  await paper()
  expect(edits()).toEqual([])
  await user.dblClick(await paper())
  await user.type(await screen.findByRole('textbox'), ' there{Control>}{Enter}{/Control}')
  await waitFor(() => expect(edits()).toEqual([{ ...AT, note: { ...NOTE, text: 'Mind the gap there' } }]))
})

it('gets another colour by the tools that the keyboard reaches from it', async () => {
  const user = shown()
  ;(await paper()).focus()
  await user.tab()
  expect(await screen.findByRole('button', { name: 'Write the note' })).toHaveFocus()
  expect(screen.getByRole('button', { name: 'Make the note blue' })).toHaveAttribute('aria-pressed', 'true')
  await user.click(screen.getByRole('button', { name: 'Make the note pink' }))
  await waitFor(() => expect(edits()).toEqual([{ ...AT, note: { ...NOTE, colour: 'pink' } }]))
})

it('follows the pointer, and is written into the document where it is let go', async () => {
  shown()
  const note = await paper()
  fireEvent.pointerDown(note, { clientX: 100, clientY: 100, button: 0, pointerId: 1 })
  fireEvent.pointerMove(note, { clientX: 130, clientY: 90, pointerId: 1 })
  expect(note.style.left).toBe('70px')
  expect(edits()).toEqual([])
  fireEvent.pointerUp(note, { clientX: 130, clientY: 90, pointerId: 1 })
  expect(note.style.left).toBe('70px')
  await waitFor(() => expect(edits()).toEqual([{ ...AT, note: { ...NOTE, position: [70, 20] } }]))
})

it('is new in the document once it says something', async () => {
  const user = shown()
  addFreeNote()
  await user.type(await screen.findByRole('textbox'), '{Escape}')
  expect(edits()).toEqual([])
  addFreeNote()
  await user.type(await screen.findByRole('textbox'), 'Both arms hold')
  await user.tab()
  await waitFor(() => expect(edits()).toMatchObject([{ path: 'root', note: { text: 'Both arms hold', colour: 'yellow' } }]))
})

it('is not seen where notes are hidden, and part of the picture of the behavior', async () => {
  shown()
  await paper()
  toggleNotes()
  await waitFor(() => expect(screen.queryByRole('button', { name: /note on the canvas/ })).toBeNull())
  const drawn = await drawingOf(
    ROOT,
    [],
    () => true,
    1000,
    () => Promise.reject(new Error('the engine was called')),
  )
  show(<Picture drawn={drawn} title="shift" palette={OF_PAGE} />)
  expect([...document.querySelectorAll('[data-note] text')].map((line) => line.textContent)).toEqual(['Mind the gap'])
  expect(document.querySelector('[data-note] rect')?.getAttribute('style')).toContain('var(--accent-soft)')
})

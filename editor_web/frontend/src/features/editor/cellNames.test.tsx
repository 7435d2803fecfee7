/** The names that the cell of a document offers. */
import { beforeEach, expect, it } from 'vitest'
import { server, session } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { keepSession } from '../../api/session'
import type { DocumentInfo } from '../../api/types'
import { newHistory } from '../../document/editing/history'
import { lookForNames } from './cellNames'
import { blank, draftOf, editor, useEditor } from './store'

const ASKED = 'POST /documents/x.yaml/names'
const NAMES = { robots: ['left'] }

beforeEach(() => {
  keepSession(session())
  server().on(ASKED, NAMES)
})

function open(cell: string | null): void {
  const start = blank('x.yaml')
  const document = { cell } as DocumentInfo
  useEditor.setState({ ...start, phase: 'ready', history: newHistory({ ...draftOf(start), document }) }, true)
}

it('are asked for once, and again when the document is opened again', async () => {
  open('cells/bench.yaml')
  await lookForNames()
  await lookForNames()
  expect(server().bodies(ASKED)).toHaveLength(1)
  open('cells/bench.yaml')
  await lookForNames()
  expect(editor().names).toEqual(NAMES)
})

it('are asked for again by the next text where they could not be told', async () => {
  server().on(ASKED, new Refusal(503, { message: 'not now' }))
  open('cells/bench.yaml')
  await lookForNames()
  expect(editor().names).toBeUndefined()
  server().on(ASKED, NAMES)
  await lookForNames()
  expect(editor().names).toEqual(NAMES)
})

it('are those of the open cell where the document names none', async () => {
  open(null)
  await lookForNames()
  expect(server().bodies(ASKED)).toEqual([])
  expect(editor().names).toBeUndefined()
})

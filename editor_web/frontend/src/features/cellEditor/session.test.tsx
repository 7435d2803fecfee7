/** The editor of the cell: edits, typing, undo, saving and conflicts, as the server answers them. */
import { waitFor } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { server } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { CellDraft } from '../../api/types'
import { edit, openCellDocument, redo, resolve, save, typed, undo } from './session'
import { cellEditor, draftOf, isDirty } from './store'

const ID = 'behaviors/cells/bench.yaml'
const AT = `/cell_documents/${ID}`

function drafted(made: string): CellDraft {
  return { text: made, hash: `hash of ${made}`, kind: 'cell', items: [], findings: [], frames: {}, parts: {}, positions: {} }
}

function text(): string {
  return draftOf(cellEditor()).text
}

beforeEach(async () => {
  server().on(`GET ${AT}`, { id: ID, saved_at: 1, draft: drafted('a') })
  await openCellDocument(ID)
})

it('makes edits one after the other, and goes back and forth among them', async () => {
  server().on(`POST ${AT}/edits`, { draft: drafted('b'), refused: null })
  expect(await edit('Add box', [])).toBe(true)
  expect([text(), isDirty(cellEditor())]).toEqual(['b', true])
  undo()
  expect([text(), isDirty(cellEditor())]).toEqual(['a', false])
  redo()
  expect(text()).toBe('b')
})

it('says why an edit is refused, and keeps the text', async () => {
  const refused = { message: '`box` is taken', hint: 'choose another name', index: 0, losses: [] }
  server().on(`POST ${AT}/edits`, { draft: drafted('a'), refused })
  expect(await edit('Rename box', [])).toBe(false)
  expect(text()).toBe('a')
  expect(cellEditor().notice).toEqual({ what: 'Rename box', message: '`box` is taken', hint: 'choose another name' })
})

it('reads what was typed before it edits it, and one stretch of typing is one step', async () => {
  server()
    .on(`POST ${AT}/draft`, drafted('abc'))
    .on(`POST ${AT}/edits`, { draft: drafted('abcd'), refused: null })
  typed('ab')
  typed('abc')
  expect(draftOf(cellEditor()).isStale).toBe(true)
  await edit('Add box', [])
  expect(cellEditor().history.steps.map(({ draft }) => draft.text)).toEqual(['a', 'abc', 'abcd'])
  expect(draftOf(cellEditor()).isStale).toBeUndefined()
})

it('asks what was typed after a pause', async () => {
  server().on(`POST ${AT}/draft`, drafted('ab'))
  typed('ab')
  await waitFor(() => expect(draftOf(cellEditor()).hash).toBe('hash of ab'))
})

it('saves what it has, and nothing where nothing was changed', async () => {
  expect(await save()).toBe(true)
  server()
    .on(`POST ${AT}/edits`, { draft: drafted('b'), refused: null })
    .on(`PUT ${AT}`, { hash: 'hash of b', saved_at: 2 })
  await edit('Add box', [])
  expect(await save()).toBe(true)
  expect([cellEditor().base, isDirty(cellEditor())]).toEqual([{ text: 'b', hash: 'hash of b' }, false])
})

it('lets a person choose where the file has other lines, and loses neither', async () => {
  const conflict = { message: 'changed', where: ID, hint: '', theirs: 'c', theirs_hash: 'hash of c', merge: null }
  server()
    .on(`POST ${AT}/edits`, { draft: drafted('b'), refused: null })
    .on(`POST ${AT}/draft`, drafted('c'))
    .on(`PUT ${AT}`, new Refusal(409, conflict))
  await edit('Add box', [])
  expect(await save()).toBe(false)
  expect(cellEditor().conflict?.theirs).toBe('c')
  await resolve('theirs')
  expect([text(), isDirty(cellEditor()), cellEditor().conflict]).toEqual(['c', false, undefined])
  undo()
  expect(text()).toBe('b')
})

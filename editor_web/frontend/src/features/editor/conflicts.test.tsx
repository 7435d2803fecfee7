/** A save that meets a changed file: merged by itself, or with a side for each field that both have changed. */
import { screen, waitFor } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { live, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { ConflictBody, DocumentAnalysis, NodeConflict, SaveBody } from '../../api/types'
import { newHistory } from '../../document/editing/history'
import { draftFrom } from './apply'
import { ConflictPanel } from './ConflictPanel'
import { NoticeLine } from './NoticeLine'
import { save } from './session'
import { blank, draftOf, editor, setEditor, useEditor } from './store'

const ID = 'behaviors/shift.yaml'
const SAVE = `PUT /documents/${ID}`
const MERGE = `POST /documents/${ID}/merge`
const DRAFT = `POST /documents/${ID}/draft`
const FINDINGS = `POST /documents/${ID}/findings`
const SPEED: NodeConflict = { path: 'root/go', field: 'with.speed', base: 1, mine: 2, theirs: 3, side: 'mine' }
const GONE: NodeConflict = { path: 'root/old', field: '', base: { state: 'a' }, mine: null, theirs: { state: 'b' }, side: 'mine' }

function analysis(hash: string): DocumentAnalysis {
  return { hash, graph: null, document: null, findings: [], checked: true }
}

function met(conflicts: readonly NodeConflict[], text = 'merged'): ConflictBody {
  return {
    message: 'the document has changed on disk',
    where: ID,
    hint: '',
    theirs: 'theirs',
    theirs_hash: 'h-theirs',
    merge: { text, conflicts, theirs_changed: ['root/wait'] },
  }
}

beforeEach(() => {
  live()
  useEditor.setState(blank(ID), true)
  setEditor({
    phase: 'ready',
    base: { text: 'base', hash: 'h-base' },
    history: newHistory(draftFrom(analysis('h-mine'), 'mine', undefined)),
  })
  server().on(DRAFT, analysis('h-merged')).on(FINDINGS, [])
})

it('saves both changes by itself where they are of different fields', async () => {
  server().on(SAVE, ({ body }: { body: SaveBody }) =>
    body.base_hash === 'h-base' ? new Refusal(409, { ...met([]) }) : { hash: 'h-merged', saved_at: 1 },
  )
  expect(await save()).toBe(true)
  expect(server().bodies(SAVE).at(-1)).toEqual({ text: 'merged', base_hash: 'h-theirs' })
  expect(editor().notice?.message).toBe('Saved with changes of the file: wait')
  expect(editor().conflict).toBeUndefined()
})

it('does not merge for ever with a file that always changes again', async () => {
  server().on(SAVE, new Refusal(409, { ...met([]) }))
  expect(await save()).toBe(false)
  expect(server().bodies(SAVE)).toHaveLength(4)
  expect(editor().notice?.message).toContain('the file has changed 4 times')
})

it('keeps the merged text unsaved where it has an error that neither had', async () => {
  server().on(SAVE, new Refusal(409, { ...met([]) }))
  const wrong = [{ severity: 'error', code: 'unknown-target', message: 'no node', path: 'root/go', line: 1, column: 1, hint: '' }]
  // The draft had none: the merged text has it.
  server().on(DRAFT, { ...analysis('h-merged'), findings: wrong })
  expect(await save()).toBe(false)
  expect(server().bodies(SAVE)).toHaveLength(1)
  expect(draftOf(editor()).text).toBe('merged')
  expect(editor().notice?.message).toContain('new errors')
})

it('asks for a side of each field that both have changed, and saves with all else merged', async () => {
  server().on(SAVE, new Refusal(409, { ...met([SPEED, GONE]) }))
  expect(await save()).toBe(false)
  const user = show(<ConflictPanel />)
  expect(screen.getByText('The file has changed: 2 conflicts, 2 open')).toBeVisible()
  expect(draftOf(editor()).text).toBe('mine')
  const saveChosen = screen.getByRole('button', { name: 'Save with these choices' })
  expect(saveChosen).toBeDisabled()
  await user.click(screen.getByRole('radio', { name: 'Theirs: 3' }))
  await user.click(screen.getByRole('radio', { name: 'Mine: removed' }))
  server()
    .on(MERGE, met([{ ...SPEED, side: 'theirs' }, GONE], 'both'))
    .on(SAVE, { hash: 'h-both', saved_at: 1 })
  await user.click(saveChosen)
  await waitFor(() => expect(server().bodies(SAVE).at(-1)).toEqual({ text: 'both', base_hash: 'h-theirs' }))
  expect(server().bodies(MERGE)).toEqual([
    { text: 'mine', base_hash: 'h-base', sides: { 'root/go with.speed': 'theirs', 'root/old ': 'mine' } },
  ])
  await waitFor(() => expect(screen.queryByRole('region', { name: 'Conflicts' })).toBeNull())
})

it('tells that the file was deleted, and saves it again', async () => {
  const socket = live()
  const user = show(<NoticeLine />)
  socket.tell({ k: 'documents', changed: { [ID]: null } })
  expect(await screen.findByRole('alert')).toHaveTextContent('The file has been deleted.')
  server().on(`POST /documents/${ID}/restore`, { text: 'base', hash: 'h-restored' }).on(SAVE, { hash: 'h-mine', saved_at: 1 })
  await user.click(screen.getByRole('button', { name: 'Save it again' }))
  await waitFor(() => expect(server().bodies(SAVE)).toEqual([{ text: 'mine', base_hash: 'h-restored' }]))
  socket.tell({ k: 'documents', changed: { [ID]: 'h-mine' } })
  await waitFor(() => expect(screen.queryByRole('alert')).toBeNull())
})

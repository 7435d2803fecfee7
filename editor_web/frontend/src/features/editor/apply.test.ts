/** Edits that are on their way to the server while something else happens to the document. */
import { beforeEach, expect, test, vi } from 'vitest'
import { documents } from '../../api/documents'
import type { EditAnswer } from '../../api/types'
import type { Edit } from '../../document/editing/edits'
import { newHistory, presentOf } from '../../document/editing/history'
import { node } from '../../document/editing/testNodes'
import { lookForFindings, perform, redo, typed, undo } from './apply'
import type { Command } from './command'
import { disabledReason } from './commands'
import { blank, draftOf, editor, rootOf, useEditor } from './store'

vi.mock('../../api/documents', () => ({ documents: { edit: vi.fn(), draft: vi.fn(), findings: vi.fn() } }))
vi.mock('../../api/client', async (original) => ({
  ...(await original<object>()),
  api: { session: () => Promise.resolve({ role: 'operator' }) },
}))

const EDIT: readonly Edit[] = [{ edit: 'duplicate', paths: ['root/a'] }]
const UNDO = { id: 'undo', words: 'Undo', needs: 'undo' } as Command

function answer(text: string): EditAnswer {
  return {
    text,
    graph: node('root', []),
    findings: [],
    checked: false,
    document: null,
    changed: [],
    refused: null,
  } as unknown as EditAnswer
}

/** A server that answers when it is told to: with the text it was sent and a `+`. */
function slowServer(): { readonly sent: string[]; readonly release: () => void } {
  const waiting: (() => void)[] = []
  const sent: string[] = []
  vi.mocked(documents.edit).mockImplementation((_id, text) => {
    sent.push(text)
    return new Promise((resolve) => waiting.push(() => resolve(answer(`${text}+`))))
  })
  return { sent, release: () => waiting.shift()?.() }
}

beforeEach(() => {
  vi.mocked(documents.findings).mockResolvedValue([])
  const draft = {
    text: 'a',
    root: node('root', []),
    hash: 'h',
    findings: [],
    isChecked: true,
    targets: [],
    areTargetsKnown: true,
    isStale: false,
    document: undefined,
  }
  useEditor.setState({ ...blank('x.yaml'), phase: 'ready', history: newHistory(draft) }, true)
})

const text = (): string => draftOf(editor()).text

test('what is on its way can be taken back before it has arrived, also where it is the first change', async () => {
  const server = slowServer()
  const done = perform('Duplicate', EDIT)
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  expect(disabledReason(UNDO)).toBeUndefined()
  undo()
  server.release()
  expect(await done).toBeDefined()
  await vi.waitFor(() => expect(text()).toBe('a'))
  expect(disabledReason(UNDO)).toBe('nothing was changed')
  redo()
  await vi.waitFor(() => expect(text()).toBe('a+'))
})

test('what is typed while an edit is on its way is kept, and edited too', async () => {
  const server = slowServer()
  const done = perform('Duplicate', EDIT)
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  typed('a typed')
  server.release()
  await vi.waitFor(() => expect(server.sent).toEqual(['a', 'a typed']))
  server.release()
  await done
  expect(text()).toBe('a typed+')
})

test('an answer for a document that was left changes nothing in the next one', async () => {
  const server = slowServer()
  const done = perform('Duplicate', EDIT)
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  const next = { ...draftOf(editor()), text: 'another' }
  useEditor.setState({ ...blank('y.yaml'), phase: 'ready', history: newHistory(next) }, true)
  server.release()
  expect(await done).toBeUndefined()
  expect(editor().history.steps.map((step) => step.draft.text)).toEqual(['another'])
})

test('a text that is not checked is looked at though the look before has only just ended', async () => {
  void lookForFindings()
  const unchecked = { ...draftOf(editor()), text: 'b', isChecked: false }
  useEditor.setState({ history: newHistory(unchecked) })
  void lookForFindings()
  await vi.waitFor(() => expect(presentOf(editor().history).draft.isChecked).toBe(true))
})

const MOVE: readonly Edit[] = [{ edit: 'set_positions', positions: { root: [7, 8] } }]

test('a position is shown before the server has written it, and is one step of undo', async () => {
  const server = slowServer()
  const done = perform('Move', MOVE)
  expect(rootOf(editor())?.position).toEqual([7, 8])
  expect(text()).toBe('a')
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  expect(vi.mocked(documents.edit).mock.lastCall?.[3]).toEqual({ check: false, graph: 'h' })
  server.release()
  await done
  expect(text()).toBe('a+')
  expect(editor().unwritten).toEqual([])
  undo()
  await vi.waitFor(() => expect(text()).toBe('a'))
  expect(rootOf(editor())?.position).toBeNull()
})

test('a position that cannot be written is as before, and the page says why', async () => {
  vi.mocked(documents.edit).mockRejectedValue(new Error('the server is gone'))
  const done = perform('Move', MOVE)
  expect(rootOf(editor())?.position).toEqual([7, 8])
  expect(await done).toBeUndefined()
  expect(rootOf(editor())?.position).toBeNull()
  expect(editor().notice).toMatchObject({ what: 'Move', tone: 'refused' })
})

test('a difference is applied to the graph that it is of, with the findings of the same answer', async () => {
  const own = { ...node('root', ['x']), line: 0 }
  const difference = { base: 'h', nodes: { root: own }, children: {}, arrows: {}, shifts: [], lines: {} }
  vi.mocked(documents.edit).mockResolvedValueOnce({ ...answer('a+'), graph: null, hash: 'g', checked: true, difference })
  vi.mocked(documents.findings).mockClear()
  await perform('Duplicate', EDIT)
  expect(draftOf(editor())).toMatchObject({ text: 'a+', hash: 'g', isChecked: true, isStale: false })
  expect(rootOf(editor())?.outcomes).toEqual(['x'])
  expect(documents.findings).not.toHaveBeenCalled()
})

test('where the difference is of another graph, the whole one is asked for', async () => {
  const difference = { base: 'other', nodes: {}, children: {}, arrows: {}, shifts: [], lines: {} }
  vi.mocked(documents.edit)
    .mockResolvedValueOnce({ ...answer('a+'), graph: null, difference })
    .mockResolvedValueOnce(answer('a+'))
  await perform('Duplicate', EDIT)
  expect(vi.mocked(documents.edit).mock.lastCall?.[3]).toEqual({ check: true, graph: null })
  expect(text()).toBe('a+')
})

/** Edits that are on their way to the server while something else happens to the document. */
import { beforeEach, expect, test, vi } from 'vitest'
import { documents } from '../../api/documents'
import type { EditAnswer } from '../../api/types'
import type { Edit } from '../../document/editing/edits'
import { newHistory, presentOf } from '../../document/editing/history'
import { machineNode, node } from '../../document/editing/testNodes'
import { lookForFindings, perform, redo, typed, undo } from './apply'
import { copy, duplicate, rename } from './actions'
import type { Command } from './command'
import { disabledReason } from './commands'
import { storedDraft } from './draftStorage'
import { openDocument } from './session'
import { blank, draftOf, editor, rootOf, useEditor } from './store'

vi.mock('../../api/documents', () => ({
  documents: { edit: vi.fn(), draft: vi.fn(), findings: vi.fn(), open: vi.fn(), catalogue: vi.fn(), copy: vi.fn() },
}))
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

const RENAME: readonly Edit[] = [{ edit: 'rename_node', path: 'root/a', name: 'b' }]

/** A machine with one state, and nothing on its way. */
function withOneState(): void {
  const root = machineNode('root', 'a', [node('root/a', ['done'])], [])
  useEditor.setState({ history: newHistory({ ...draftOf(editor()), root }) })
}

test('a new name is shown before the server has written it, and the node stays the selected one', async () => {
  withOneState()
  const server = slowServer()
  useEditor.setState({ renaming: 'root/a', selection: ['root/a'] })
  const done = rename('root/a', 'b')
  expect(rootOf(editor())?.children.map((child) => child.path)).toEqual(['root/b'])
  expect(editor().selection).toEqual(['root/b'])
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  server.release()
  await done
  expect(editor().unwritten).toEqual([])
})

test('what the server refuses is as before, and so is what was selected', async () => {
  withOneState()
  const refused = { message: 'no', hint: '', index: 0, losses: [] }
  vi.mocked(documents.edit).mockResolvedValue({ ...answer('a'), refused })
  useEditor.setState({ renaming: 'root/a', selection: ['root/a'] })
  await rename('root/a', 'b')
  expect(rootOf(editor())?.children.map((child) => child.path)).toEqual(['root/a'])
  expect(editor().selection).toEqual(['root/a'])
  expect(editor().notice).toMatchObject({ message: 'no', tone: 'refused' })
})

test('edits that wait for each other are all shown', async () => {
  withOneState()
  const server = slowServer()
  const both = [perform('Rename', RENAME), perform('Duplicate', [{ edit: 'duplicate', paths: ['root/b'] }])]
  expect(rootOf(editor())?.children.map((child) => child.name)).toEqual(['b', 'b_2'])
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  server.release()
  await vi.waitFor(() => expect(server.sent).toEqual(['a', 'a+']))
  server.release()
  await Promise.all(both)
  expect(text()).toBe('a++')
})

test('copies that are shown are what the next key is for; the original where they are refused', async () => {
  withOneState()
  const server = slowServer()
  useEditor.setState({ selection: ['root/a'] })
  const done = duplicate()
  expect(editor().selection).toEqual(['root/a_2'])
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  vi.mocked(documents.edit).mockRejectedValue(new Error('the server is gone'))
  server.release()
  await done
  withOneState()
  useEditor.setState({ selection: ['root/a'] })
  await duplicate()
  expect(editor().selection).toEqual(['root/a'])
})

const NO_EDIT = { message: 'no', hint: '', index: 0, losses: [] }

test('two names in a row: the answer to the first leaves the node with its second name selected', async () => {
  withOneState()
  const waiting: (() => void)[] = []
  vi.mocked(documents.edit).mockImplementation((_id, before, edits) => {
    const [edit] = edits
    const name = edit?.edit === 'rename_node' ? edit.name : ''
    const graph = machineNode('root', name, [node(`root/${name}`, ['done'])], [])
    return new Promise((resolve) => waiting.push(() => resolve({ ...answer(`${before}+`), graph })))
  })
  useEditor.setState({ renaming: 'root/a', selection: ['root/a'] })
  const first = rename('root/a', 'b')
  useEditor.setState({ renaming: 'root/b' })
  const second = rename('root/b', 'c')
  await vi.waitFor(() => expect(waiting).toHaveLength(1))
  waiting.shift()?.()
  await first
  const between = editor().selection
  await vi.waitFor(() => expect(waiting).toHaveLength(1))
  waiting.shift()?.()
  await second
  expect([between, editor().selection]).toEqual([['root/c'], ['root/c']])
})

test('a refused edit does not take the selection from what was chosen meanwhile', async () => {
  const root = machineNode('root', 'a', [node('root/a', ['done']), node('root/z', ['done'])], [])
  useEditor.setState({ history: newHistory({ ...draftOf(editor()), root }), renaming: 'root/a', selection: ['root/a'] })
  vi.mocked(documents.edit).mockResolvedValue({ ...answer('a'), refused: NO_EDIT })
  const done = rename('root/a', 'b')
  useEditor.setState({ selection: ['root/z'] })
  await done
  expect(editor().selection).toEqual(['root/z'])
})

test('an edit on its way when another document is opened is kept in the draft, and selects nothing in the other', async () => {
  withOneState()
  const server = slowServer()
  const read = { ...answer('y'), hash: 'y', graph: machineNode('root', 'a', [node('root/a', ['done'])], []) }
  vi.mocked(documents.open).mockResolvedValue(read as never)
  vi.mocked(documents.catalogue).mockResolvedValue({} as never)
  useEditor.setState({ renaming: 'root/a', selection: ['root/a'] })
  const done = rename('root/a', 'b')
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  const kept = new Map<string, string>()
  vi.stubGlobal('localStorage', {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => kept.set(key, value),
    removeItem: (key: string) => kept.delete(key),
  })
  const opened = openDocument('y.yaml', '')
  server.release()
  await Promise.all([done, opened])
  expect(storedDraft('x.yaml')?.text).toBe('a+')
  expect(editor().id).toBe('y.yaml')
  expect(editor().selection).toEqual([])
})

test('a copy that is shown and not written yet can be copied', async () => {
  withOneState()
  const server = slowServer()
  const texts: string[] = []
  vi.mocked(documents.copy).mockImplementation((_id, from) => {
    texts.push(from)
    return Promise.resolve({ yaml: 'x' } as never)
  })
  useEditor.setState({ selection: ['root/a'] })
  const made = duplicate()
  const copied = copy()
  await vi.waitFor(() => expect(server.sent).toEqual(['a']))
  server.release()
  await Promise.all([made, copied])
  expect(texts).toEqual(['a+'])
})

test('why the first of two edits is refused is not hidden by the second, which is written', async () => {
  withOneState()
  vi.mocked(documents.edit).mockResolvedValueOnce({ ...answer('a'), refused: NO_EDIT })
  vi.mocked(documents.edit).mockResolvedValueOnce(answer('a+'))
  await Promise.all([perform('Rename', RENAME), perform('Duplicate', EDIT)])
  expect(text()).toBe('a+')
  expect(editor().notice).toMatchObject({ what: 'Rename', message: 'no' })
  vi.mocked(documents.edit).mockResolvedValueOnce(answer('a++'))
  await perform('Duplicate', EDIT)
  expect(editor().notice).toBeUndefined()
})

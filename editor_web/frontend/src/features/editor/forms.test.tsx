/** The forms of the editor: what each asks the server to change, on what the document is by then. */
import { screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { live, server, session, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { CatalogueBody, ConcurrencyCondition, DocumentInfo, DocumentNode, Edit, EditAnswer } from '../../api/types'
import { newHistory } from '../../document/editing/history'
import { nodeOf } from '../../document/editing/model'
import { draftFrom } from './apply'
import { DocumentForm } from './DocumentForm'
import { PolicyForm } from './PolicyForm'
import { RulesForm } from './RulesForm'
import { blank, rootOf, setEditor, useEditor } from './store'

const ID = 'behaviors/shift.yaml'
const EDITS = `POST /documents/${ID}/edits`
const INFO: DocumentInfo = {
  name: 'shift',
  description: '',
  cell: null,
  parameters: {},
  userdata: {},
  outcomes: ['good', 'bad'],
  success: ['good'],
}

function part(path: string, told: Partial<DocumentNode> = {}): DocumentNode {
  const name = path.split('/').at(-1) ?? path
  return {
    path,
    name,
    kind: 'state',
    icon: 'state',
    title: 'test.Give',
    outcomes: ['a', 'b', 'c'],
    children: [],
    transitions: [],
    initial: null,
    conditions: [],
    label: name,
    role: '',
    description: '',
    line: 1,
    column: 1,
    end_line: 1,
    state: 'test.Give',
    reference: null,
    document: null,
    parameters: {},
    inputs: {},
    outputs: {},
    targets: {},
    exits: [],
    autonomy: {},
    timeout: null,
    retry: null,
    guard: null,
    post: null,
    on_error: null,
    resume: null,
    success: [],
    every: null,
    notes: '',
    canvas_notes: {},
    position: null,
    rules: [],
    otherwise: null,
    userdata: {},
    settings: {},
    disabled: false,
    ...told,
  }
}

function rule(outcome: string, when: ConcurrencyCondition['when'], told: Partial<ConcurrencyCondition> = {}): ConcurrencyCondition {
  return { outcome, when, at_least: null, preempt: [], ...told }
}

const RULES = [rule('finished', { left: 'a', right: 'a' }), rule('odd', { left: 'b' }), rule('odd', { right: 'b' })]
const BOTH = part('root/both', {
  kind: 'concurrency',
  state: null,
  outcomes: ['finished', 'odd'],
  children: [part('root/both/left'), part('root/both/right')],
  rules: RULES,
})
const SET = part('root/set', { outcomes: ['done'] })
const LOOK = part('root/watch/look')
const WATCH = part('root/watch', { kind: 'sequence', state: null, children: [LOOK], settings: { memory: false } })
const ROOT = part('root', { kind: 'machine', state: null, outcomes: ['good', 'bad'], children: [SET, BOTH, WATCH], initial: 'set' })

/** The document with other rules, as the server answers after an edit. */
function answered(root: DocumentNode): EditAnswer {
  return {
    hash: 'h2',
    graph: root,
    document: INFO,
    findings: [],
    checked: true,
    text: `${Math.random()}`,
    changed: [],
    refused: null,
    difference: null,
  }
}

function Form({ path }: { readonly path: string }) {
  const root = useEditor(rootOf)
  const node = nodeOf(root, path)
  const parent = nodeOf(root, path.split('/').slice(0, -1).join('/'))
  if (!node) return null
  return node.rules.length > 0 ? <RulesForm node={node} /> : <PolicyForm node={node} parent={parent} />
}

function edits(): Edit[] {
  return (server().bodies(EDITS) as { edits: Edit[] }[]).flatMap((body) => body.edits)
}

function rows(): string[] {
  return within(screen.getByRole('region', { name: 'Rules' }))
    .getAllByRole('row')
    .map((each) => each.textContent ?? '')
}

beforeEach(() => {
  server()
    .on('GET /session', session())
    .on(EDITS, answered(ROOT))
    .on(`POST /documents/${ID}/findings`, [])
    .on(`POST /documents/${ID}/targets`, { findings: [], dropped: false, problem: '' })
  live()
  useEditor.setState(blank(ID), true)
  const draft = draftFrom({ hash: 'h1', graph: ROOT, findings: [], checked: true, document: INFO }, 'one', undefined)
  setEditor({ phase: 'ready', base: { text: 'one', hash: 'h1' }, history: newHistory(draft) })
})

it('edits the rules of a concurrency as a table, a line for each rule, a column for each child', async () => {
  const user = show(<Form path="root/both" />)
  expect(rows()).toHaveLength(4)
  await user.selectOptions(screen.getByLabelText('right in rule 1'), 'b')
  await waitFor(() => expect(edits()).toHaveLength(1))
  const path = 'root/both'
  const conditions = (value: unknown) => ({ edit: 'set_field', path, field: 'conditions', value })
  expect(edits()[0]).toEqual(conditions([{ finished: { left: 'a', right: 'b' } }, { odd: { left: 'b' } }, { odd: { right: 'b' } }]))
  await user.selectOptions(screen.getByLabelText('How many in rule 1'), '1')
  await user.click(screen.getByRole('button', { name: 'Delete rule 3' }))
  await user.click(screen.getByRole('button', { name: 'Move rule 2 up' }))
  await waitFor(() => expect(edits()).toHaveLength(4))
  const [all, left, right] = [{ finished: { left: 'a', right: 'a' } }, { odd: { left: 'b' } }, { odd: { right: 'b' } }]
  expect(edits().slice(1)).toEqual([
    conditions([{ finished: { left: 'a', right: 'a', at_least: 1 } }, left, right]),
    conditions([all, left]),
    conditions([left, all, right]),
  ])
})

it('keeps two changes of rules of which the second is made before the first is answered', async () => {
  let answer: (root: object) => void = () => undefined
  server().on(EDITS, () => new Promise((resolve) => (answer = resolve)))
  const user = show(<Form path="root/both" />)
  await user.click(screen.getByRole('button', { name: 'Delete rule 3' }))
  await waitFor(() => expect(edits()).toHaveLength(1))
  await user.click(screen.getByRole('button', { name: 'Delete rule 2' }))
  server().on(EDITS, answered(ROOT))
  answer(answered({ ...ROOT, children: [SET, { ...BOTH, rules: RULES.slice(0, 2) }] }))
  await waitFor(() => expect(edits()).toHaveLength(2))
  expect(edits()[1]).toMatchObject({ value: [{ finished: { left: 'a', right: 'a' } }] })
})

it('lets a rule preempt some branches while the others go on; then it has no outcome', async () => {
  const preempting = {
    ...BOTH,
    rules: [RULES[0] ?? BOTH.rules[0], rule('', { left: 'b' }, { preempt: ['right'] })] as ConcurrencyCondition[],
  }
  server().on(EDITS, answered({ ...ROOT, children: [SET, preempting] }))
  const user = show(<Form path="root/both" />)
  const words = 'all: preempted by rule 2'
  await user.click(screen.getByLabelText(words))
  const choice = within(screen.getByLabelText(words).closest('details') ?? document.body)
  await user.click(choice.getByLabelText('right'))
  await waitFor(() => expect(edits()[0]).toMatchObject({ field: 'conditions' }))
  expect((edits()[0] as { value: unknown[] }).value[1]).toEqual({ preempt: ['right'], when: { left: 'b' } })
  expect(await screen.findByLabelText('right: preempted by rule 2')).toHaveTextContent('right')
  expect(screen.queryByLabelText('Outcome of rule 2')).toBeNull()
})

it('adds a rule of what is not said yet', async () => {
  const user = show(<Form path="root/both" />)
  await user.click(screen.getByRole('button', { name: 'Add a rule' }))
  await waitFor(() => expect((edits()[0] as { value: unknown[] }).value[3]).toEqual({ failed: { left: 'c' } }))
})

it('renames the outcome of a rule, and says what comes of none', async () => {
  const renamed = { ...BOTH, rules: RULES.map((each, at) => (at === 1 ? { ...each, outcome: 'uneven' } : each)) }
  server().on(EDITS, answered({ ...ROOT, children: [SET, renamed, WATCH] }))
  const user = show(<Form path="root/both" />)
  await user.clear(screen.getByLabelText('Outcome of rule 2'))
  await user.type(screen.getByLabelText('Outcome of rule 2'), 'uneven{Enter}')
  await waitFor(() => expect((edits()[0] as { value: unknown[] }).value[1]).toEqual({ uneven: { left: 'b' } }))
  await user.type(screen.getByLabelText('Outcome when no rule holds'), 'late{Enter}')
  await waitFor(() => expect(edits()[1]).toEqual({ edit: 'set_field', path: 'root/both', field: 'otherwise', value: 'late' }))
})

it('leads a timeout to the worst outcome at first, and takes it away with its time', async () => {
  const slow = { ...SET, timeout: { after: '30 s', to: 'bad' } }
  server().on(EDITS, answered({ ...ROOT, children: [slow, BOTH, WATCH] }))
  const user = show(<Form path="root/set" />)
  await user.click(screen.getByRole('button', { name: 'Guard, timeout, retry' }))
  await user.type(screen.getByRole('combobox', { name: 'Timeout' }), '30 s{Enter}')
  const timeout = (value: unknown) => ({ edit: 'set_field', path: 'root/set', field: 'timeout', value })
  await waitFor(() => expect(edits()).toEqual([timeout({ to: 'bad', after: '30 s' })]))
  expect(await screen.findByLabelText('Timeout target')).toHaveValue('bad')
  await user.clear(screen.getByRole('combobox', { name: 'Timeout' }))
  await user.type(screen.getByRole('combobox', { name: 'Timeout' }), '{Enter}')
  await waitFor(() => expect(edits()[1]).toEqual(timeout(null)))
})

it('sets retry and what is done after a crash', async () => {
  server().on(EDITS, answered({ ...ROOT, children: [{ ...SET, retry: { times: 3 } }, BOTH, WATCH] }))
  const user = show(<Form path="root/set" />)
  await user.click(screen.getByRole('button', { name: 'Guard, timeout, retry' }))
  await user.type(screen.getByRole('combobox', { name: 'Retry, times' }), '3{Enter}')
  await user.selectOptions(screen.getByLabelText('After a crash'), 'ask')
  await waitFor(() => expect(edits()).toHaveLength(2))
  expect(edits()).toMatchObject([
    { field: 'retry', value: { times: 3 } },
    { field: 'resume', value: 'ask' },
  ])
})

it('asks how often a check is asked again where the composite has no memory, and only there', async () => {
  const user = show(<Form path="root/watch/look" />)
  await user.click(screen.getByRole('button', { name: 'Guard, timeout, retry' }))
  await user.type(screen.getByRole('combobox', { name: 'Ask again every' }), '200 ms{Enter}')
  await waitFor(() => expect(edits()).toEqual([{ edit: 'set_field', path: 'root/watch/look', field: 'every', value: '200 ms' }]))
  const kept = { ...WATCH, settings: { memory: true } }
  server().on(EDITS, answered({ ...ROOT, children: [SET, BOTH, kept] }))
  await user.selectOptions(screen.getByLabelText('After a crash'), 'ask')
  await waitFor(() => expect(screen.queryByRole('combobox', { name: 'Ask again every' })).toBeNull())
})

it('says what the server refuses, and leaves the document as it was', async () => {
  server().on(EDITS, { ...answered(ROOT), refused: { message: 'no such node', hint: 'load it again' } })
  const user = show(<Form path="root/both" />)
  await user.click(screen.getByRole('button', { name: 'Delete rule 3' }))
  await waitFor(() =>
    expect(useEditor.getState().notice).toMatchObject({ what: 'Delete a rule', message: 'no such node', hint: 'load it again' }),
  )
  server().on(EDITS, new Refusal(500, { message: 'the server has failed' }))
  await user.click(screen.getByRole('button', { name: 'Delete rule 3' }))
  await waitFor(() => expect(useEditor.getState().notice).toMatchObject({ message: 'the server has failed' }))
  expect(rows()).toHaveLength(4)
})

const CATALOGUE: CatalogueBody = {
  states: [],
  containers: [],
  behaviors: [],
  entries: [{ kind: 'joints', name: 'home' }],
  names: { robot: ['left', 'right'], camera: ['eye'] },
}

function declaring(parameters: DocumentInfo['parameters']) {
  const document = { ...INFO, parameters }
  const draft = draftFrom({ hash: 'h1', graph: ROOT, findings: [], checked: true, document }, 'one', undefined)
  setEditor({ history: newHistory(draft), catalogue: CATALOGUE })
  return show(<DocumentForm />)
}

it('declares what a text parameter names, in the place of what it named before', async () => {
  const user = declaring({ arm: { type: 'string', entry: 'joints', default: 'left' }, speed: { type: 'number', default: 1 } })
  expect(screen.queryByLabelText('What speed names')).toBeNull()
  const kind = screen.getByLabelText('What arm names')
  expect(kind).toHaveValue('entry joints')
  const kinds = within(kind).getAllByRole('option')
  expect(kinds.map((each) => each.textContent)).toEqual(['nothing of the cell', 'camera', 'robot', 'entry: joints'])
  await user.selectOptions(kind, 'robot')
  await waitFor(() => expect(edits()).toHaveLength(1))
  const arm = { type: 'string', default: 'left', cell_name: 'robot' }
  expect(edits()[0]).toEqual({ edit: 'set_document', changes: { parameters: { arm, speed: { type: 'number', default: 1 } } } })
})

it('offers the names that fit as the default of a parameter', async () => {
  const user = declaring({ arm: { type: 'string', cell_name: 'robot' } })
  await user.click(screen.getByLabelText('Default of arm'))
  const list = await screen.findByRole('listbox')
  expect(
    within(list)
      .getAllByRole('option')
      .map((each) => each.textContent),
  ).toEqual(['left', 'right'])
})

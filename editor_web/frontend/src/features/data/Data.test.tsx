/** The userdata of a run: every value with its writer and time, found by words, lit when it is written. */
import { screen, waitFor, within } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { control, live, run, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { useRefusal } from '../../api/refusal'
import type { ScopeView, UserdataRecord, WatchValue } from '../../api/types'
import { watchValueOf } from '../../api/watches'
import { Data } from './Data'

const RUN = run()
const SHIFT = { id: 'behaviors/shift.yaml', parameters: [] }
const chosen = vi.fn()

function value(of: unknown, by = '', writes = 0): UserdataRecord {
  return { value: of, by, at_s: by ? 0.25 : 0, writes }
}

const SCOPES: Record<string, ScopeView> = {
  '': { is_open: true, since_s: 0, values: { count: value(1, 'root/count', 1), found: value([]), pose: value({ xyz: [0.1, 0.2, 0.3] }) } },
  'root/look': { is_open: false, since_s: 0, values: { local: value('a long note', 'root/look/note', 1) } },
}

const WHOLE = { scope: '', key: 'count', value: 1 }

/** The data of a run, as the server tells of it. */
function told(scopes = SCOPES, problem = '', watched: readonly WatchValue[] = [], isPaused = false) {
  live({ run: 'r1', runs: [RUN], control: control({ paused: isPaused }) })
  const user = show(<Data run={RUN} behavior={SHIFT} onShow={chosen} />)
  const socket = server().socket('/data')
  socket.accept()
  socket.tell({ k: 'userdata', run: 'r1', first: true, scopes, watches: watched, problem })
  return { user, socket }
}

function line(name: string): HTMLElement {
  const found = within(screen.getByRole('region', { name: 'Behavior' }))
    .getAllByRole('listitem')
    .find((each) => each.textContent?.startsWith(name))
  if (!found) throw new Error(`there is no line ${name}`)
  return found
}

function watches(): HTMLElement {
  return screen.getByRole('region', { name: 'Watches' })
}

it('asks for the run alone while nothing is watched', () => {
  expect(told().socket.sent).toEqual([{ k: 'look', run: 'r1' }])
})

it('watches an expression that is typed, with names offered, and shows its value', async () => {
  const { user, socket } = told()
  await user.type(screen.getByRole('combobox', { name: 'New watch' }), 'size(fou')
  await user.click(await screen.findByRole('option', { name: 'found' }))
  await user.type(screen.getByRole('combobox', { name: 'New watch' }), '){Enter}')
  expect(socket.sent.at(-1)).toEqual({ k: 'look', run: 'r1', watches: [{ expression: 'size(found)' }] })
  expect(screen.getByRole('combobox', { name: 'New watch' })).toHaveValue('')
  socket.tell({ k: 'userdata', run: 'r1', first: true, scopes: SCOPES, watches: [{ value: 2, problem: '' }], problem: '' })
  expect(within(watches()).getByRole('listitem')).toHaveTextContent('size(found)2')
  expect(localStorage.getItem('flexcell.watches')).toContain('size(found)')
})

it('edits a watch in place, keeps it with Escape, and says why it has no value', async () => {
  watchValueOf(SHIFT.id, { expression: 'count', path: 'root/look' })
  const { user, socket } = told(SCOPES, '', [{ value: null, problem: '`count` is not defined here' }])
  expect(watches()).toHaveTextContent('`count` is not defined here')
  expect(watches()).toHaveTextContent('at look')
  await user.click(screen.getByRole('button', { name: 'Edit the watch count' }))
  await user.keyboard(' + 1{Escape}')
  expect(screen.getByRole('button', { name: 'Edit the watch count' })).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Edit the watch count' }))
  await user.keyboard(' + 1{Enter}')
  expect(socket.sent.at(-1)).toEqual({ k: 'look', run: 'r1', watches: [{ expression: 'count + 1', path: 'root/look' }] })
  await user.click(screen.getByRole('button', { name: 'Remove the watch count + 1' }))
  expect(socket.sent.at(-1)).toEqual({ k: 'look', run: 'r1' })
})

it('watches a value of the list where it stands', async () => {
  const { user, socket } = told()
  await user.click(screen.getByRole('button', { name: 'Watch local' }))
  await user.click(screen.getByRole('button', { name: 'Watch local' }))
  expect(socket.sent.at(-1)).toEqual({ k: 'look', run: 'r1', watches: [{ expression: 'local', path: 'root/look' }] })
})

it('says that no run is shown', () => {
  show(<Data run={undefined} behavior={SHIFT} onShow={chosen} />)
  expect(screen.getByText('No run is shown')).toBeVisible()
})

it('shows every value with who wrote it and when; those of a container that was left stay', async () => {
  chosen.mockReset()
  const { user } = told()
  expect(line('count')).toHaveTextContent('count1root/count at 0.25 s')
  expect(line('found')).toHaveTextContent('found[]from the start')
  expect(line('pose')).toHaveTextContent('[0.1, 0.2, 0.3]')
  const left = screen.getByRole('region', { name: 'root/look' })
  expect(left).toHaveTextContent('over')
  expect(left).toHaveTextContent('a long note')
  await user.click(within(left).getByRole('button', { name: 'root/look/note' }))
  expect(chosen.mock.calls).toEqual([['root/look/note']])
})

it('finds values by names, texts and writers', async () => {
  const { user } = told()
  await user.type(screen.getByLabelText('Find in the data'), 'note local')
  expect(screen.queryByRole('region', { name: 'Behavior' })).toBeNull()
  expect(screen.getByRole('region', { name: 'root/look' })).toBeVisible()
  await user.type(screen.getByLabelText('Find in the data'), ' nowhere')
  expect(screen.getByText('Nothing matches')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Clear' }))
  expect(line('count')).toBeVisible()
})

it('lights what is written, and tells how often it was', () => {
  const { socket } = told()
  expect(line('found').querySelector('[data-written]')).toBeNull()
  const values = { ...SCOPES['']?.values, found: { ...value(['cup'], 'root/look', 2), at_s: 0.5 } }
  socket.tell({ k: 'userdata', run: 'r1', first: false, scopes: { '': { is_open: true, since_s: 0, values } }, watches: [], problem: '' })
  expect(line('found').querySelector('[data-written]')).toHaveTextContent('[cup]')
  expect(line('found')).toHaveTextContent('root/look at 0.50 s, ×2')
  expect(screen.getByRole('region', { name: 'root/look' })).toBeVisible()
})

it('takes away a scope that is gone', () => {
  const { socket } = told()
  socket.tell({ k: 'userdata', run: 'r1', first: false, scopes: { 'root/look': null }, watches: [], problem: '' })
  expect(screen.queryByRole('region', { name: 'root/look' })).toBeNull()
})

it('says why there is nothing to show', () => {
  const { socket } = told({}, '')
  expect(screen.getByText('This behavior shares no data')).toBeVisible()
  socket.tell({ k: 'userdata', run: 'r1', first: true, scopes: {}, watches: [], problem: 'the run is not in memory any more' })
  expect(screen.getByText('the run is not in memory any more')).toBeVisible()
})

it('changes a value of a paused run where it stands', async () => {
  server()
    .on('POST /runs/r1/control/userdata', control({ paused: true }))
    .on('GET /runs/r1/control/userdata', WHOLE)
  const { user, socket } = told(SCOPES, '', [], true)
  await user.click(screen.getByRole('button', { name: 'Change count' }))
  const field = await screen.findByLabelText('New value of count')
  expect(field).toHaveFocus()
  await user.clear(field)
  await user.type(field, '"many"')
  expect(line('count')).toHaveTextContent('It was a number; this is text')
  await user.type(field, '{Enter}')
  expect(server().bodies('POST /runs/r1/control/userdata')).toEqual([{ scope: '', key: 'count', value: 'many' }])
  await waitFor(() => expect(screen.queryByLabelText('New value of count')).toBeNull())
  const values = { ...SCOPES['']?.values, count: { value: 'many', by: '', at_s: 2, writes: 2 } }
  socket.tell({ k: 'userdata', run: 'r1', first: false, scopes: { '': { is_open: true, since_s: 0, values } }, watches: [], problem: '' })
  expect(line('count')).toHaveTextContent('countmanyset by a person at 2.00 s')
})

it('says what is wrong with a value, and keeps what was typed', async () => {
  const words = { message: 'there is no such key', hint: 'look again' }
  server().on('POST /runs/r1/control/userdata', new Refusal(422, words)).on('GET /runs/r1/control/userdata', WHOLE)
  const { user } = told(SCOPES, '', [], true)
  await user.click(screen.getByRole('button', { name: 'Change count' }))
  const field = await screen.findByLabelText('New value of count')
  await user.clear(field)
  await user.type(field, 'many{Enter}')
  expect(line('count')).toHaveTextContent('This is not JSON')
  expect(screen.getByRole('button', { name: 'Set value' })).toBeDisabled()
  await user.clear(field)
  await user.type(field, '3{Enter}')
  expect(await screen.findByText('there is no such key (look again)')).toBeVisible()
  expect(field).toHaveValue('3')
  await user.type(field, '{Escape}')
  expect(line('count')).toHaveTextContent('count1')
})

it('changes nothing while the run goes on, and nothing of what is over', async () => {
  const { user } = told()
  await user.click(screen.getByRole('button', { name: 'Change count' }))
  expect(useRefusal.getState().refusal).toEqual({ what: 'Change count', message: 'pause the run first', hint: '' })
  expect(screen.queryByLabelText('New value of count')).toBeNull()
  expect(screen.queryByRole('button', { name: 'Change local' })).toBeNull()
})

/** The userdata of a run: every value with its writer and time, found by words, lit when it is written. */
import { screen, within } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { live, run, server, show } from '../../../testing/page'
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

/** The data of a run, as the server tells of it. */
function told(scopes = SCOPES, problem = '', watched: readonly WatchValue[] = []) {
  live({ run: 'r1', runs: [RUN] })
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

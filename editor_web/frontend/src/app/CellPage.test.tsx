/** The page of the cell: its tree by keyboard and mouse, states that follow the robots, and the lines of the document. */
import { screen, waitFor, within } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { live, robot, server, session, show } from '../../testing/page'
import { Refusal } from '../../testing/server'
import { keepSession } from '../api/session'
import type { CellItems } from '../api/types'
import { CellPage } from './CellPage'

const CELL: CellItems = {
  cell: 'bench',
  description: 'A bench with an arm.',
  file: 'bench.yaml',
  changed: false,
  items: [
    {
      path: 'robots/left',
      kind: 'robot',
      name: 'left',
      model: 'panda',
      owner: '',
      topics: ['left/joint_state', 'left/status'],
      text: 'left:\n  model: panda',
      line: 6,
      file: '',
    },
    {
      path: 'robots/left/gripper',
      kind: 'tool',
      name: 'left',
      model: 'panda_hand',
      owner: 'robots/left',
      topics: [],
      text: 'gripper: {model: panda_hand}',
      line: 7,
      file: '',
    },
    { path: 'parts/plate', kind: 'part', name: 'plate', model: 'box', owner: '', topics: [], text: '', line: 0, file: '' },
  ],
}

function page(item: string, onOpen = vi.fn(), role = 'operator') {
  if (role === 'operator') server().on('GET /cell_documents', [])
  return { onOpen, user: show(<CellPage item={item} session={session({ role, cell_view_port: 9 })} isNarrow={false} onOpen={onOpen} />) }
}

/** The socket of the page that hears where the items are. */
function told(state: object): void {
  const socket = server().socket('/data')
  socket.accept()
  socket.tell({ k: 'cell', poses: {}, cameras: {}, tools: {}, devices: {}, modules: {}, ...state })
}

it('shows the items with what they do, hold, and where they are', async () => {
  server().on('GET /cell/items', CELL)
  const socket = live({ robots: { left: robot({ mode: 'moving', activity: 'move_pose' }) } })
  page('')
  const tree = await screen.findByRole('tree', { name: 'Items of the cell' })
  expect(screen.getByRole('heading', { name: 'bench' })).toBeVisible()
  expect(within(tree).getByText('carries out move_pose')).toBeVisible()
  told({ poses: { plate: { xyz: [0.1, 0, 0.02], xyzw: [0, 0, 0, 1], frame: 'world' } }, tools: { left: { held: false, part: '' } } })
  expect(within(tree).getByText('0.100, 0.000, 0.020 m')).toBeVisible()
  expect(within(tree).getByText('holds nothing')).toBeVisible()
  socket.tell({
    k: 'delta',
    run: '',
    after: 1,
    seq: 2,
    now_s: 1,
    ticking: false,
    runs: [],
    nodes: {},
    log: [],
    dropped: 0,
    robots: { left: robot({ mode: 'idle' }) },
    control: null,
    lock_reasons: {},
  })
  await waitFor(() => expect(within(tree).getByText('idle')).toBeVisible())
})

it('selects an item by mouse and by keyboard; a group folds', async () => {
  server().on('GET /cell/items', CELL)
  live()
  const { user, onOpen } = page('')
  const tree = await screen.findByRole('tree', { name: 'Items of the cell' })
  await user.click(within(tree).getByText('Parts'))
  expect(within(tree).queryByText('plate')).toBeNull()
  expect(onOpen).not.toHaveBeenCalled()
  await user.click(within(tree).getByText('gripper'))
  expect(onOpen).toHaveBeenCalledExactlyOnceWith('/workcell/robots/left/gripper')
  await user.keyboard('{ArrowUp}{Enter}')
  expect(onOpen).toHaveBeenLastCalledWith('/workcell/robots/left')
  await user.keyboard('{ArrowUp}{Enter}')
  expect(within(tree).queryByText('gripper')).toBeNull()
})

it('tells of a robot its state, its topics and its lines of the document', async () => {
  server().on('GET /cell/items', { ...CELL, changed: true })
  live({ robots: { left: robot({ mode: 'reflex', error: 'torque of joint 4' }) } })
  const { user, onOpen } = page('robots/left')
  const state = await screen.findByRole('table', { name: 'State of left' })
  expect(state).toHaveTextContent('stopped by a reflex')
  expect(state).toHaveTextContent('torque of joint 4')
  expect(screen.getByRole('combobox', { name: 'Topic' })).toHaveValue('left/status')
  const lines = screen.getByRole('region', { name: 'Document' })
  expect(lines).toHaveTextContent('bench.yaml, line 6')
  expect(lines).toHaveTextContent('model: panda')
  expect(lines).toHaveTextContent('The document has changed since the cell was opened')
  await user.click(screen.getByRole('button', { name: 'Jog and teach' }))
  expect(onOpen).toHaveBeenCalledWith('/teach')
})

it('opens at the topic of the address', async () => {
  server().on('GET /cell/items', CELL)
  live({ robots: { left: robot() } })
  history.replaceState(null, '', '#left/joint_state')
  page('robots/left')
  expect(await screen.findByRole('combobox', { name: 'Topic' })).toHaveValue('left/joint_state')
  history.replaceState(null, '', location.pathname)
})

it('leads from a held part to the arm, and says that the document has it no more', async () => {
  server().on('GET /cell/items', CELL)
  live({ robots: { left: robot() } })
  const { user, onOpen } = page('parts/plate')
  await screen.findByText('The document does not have it any more.')
  told({ tools: { left: { held: true, part: 'plate' } } })
  await user.click(screen.getByRole('button', { name: 'left' }))
  expect(onOpen).toHaveBeenCalledWith('/workcell/robots/left')
})

it('offers a viewer no jogging', async () => {
  server().on('GET /cell/items', CELL)
  live({ robots: { left: robot() } }, 'viewer')
  page('robots/left', vi.fn(), 'viewer')
  await screen.findByRole('table', { name: 'State of left' })
  expect(screen.queryByRole('button', { name: 'Jog and teach' })).toBeNull()
})

it('says that the cell has no such item, and why nothing can be shown', async () => {
  server().on('GET /cell/items', CELL)
  live()
  page('robots/lft')
  expect(await screen.findByText('This cell has no such item')).toBeVisible()
})

it('says why the cell cannot be read', async () => {
  server().on('GET /cell/items', new Refusal(500, { message: 'the server is ending' }))
  live()
  page('')
  expect(await screen.findByText(/the server is ending/)).toBeVisible()
})

it('says of a device with a driver whether it is real', async () => {
  const known = session({ devices: [{ device: 'left/gripper', driver: 'robotiq', simulated: false }] })
  server().on('GET /session', known)
  keepSession(known)
  server().on('GET /cell/items', CELL)
  live()
  page('robots/left/gripper')
  expect(await screen.findByText('robotiq, real')).toBeVisible()
})

it('shows of a real tool in the tree that it may not move, and beside it how it is enabled', async () => {
  server().on('GET /cell_documents', [])
  const known = session({ devices: [{ device: 'left/gripper', driver: 'robotiq', simulated: false }] })
  const details = { device: 'left/gripper', address: 'left/gripper', driver: 'robotiq', simulated: false, options: {}, schema: {} }
  const words = {
    can: ['gripper commands'],
    cannot: [],
    proven: 'Never run on hardware.',
    page: '',
    enabling: 'Activates it.',
    problem: '',
  }
  server().on('GET /cell/items', CELL)
  server().on('GET /cell/devices', [{ ...details, ...words }])
  live()
  show(<CellPage item="robots/left/gripper" session={known} isNarrow={false} onOpen={vi.fn()} />)
  const tree = await screen.findByRole('tree', { name: 'Items of the cell' })
  const state = { driver: 'robotiq', address: 'here:1', connected: true, enabled: false, problem: 'not activated', mode: 'reading' }
  const rest = { fault: '', firmware: '', safety: '', last_cause: '', last_cause_unix_s: 0, enabled_by: '', enabled_for: '' }
  told({ devices: { 'left/gripper': { state: { ...state, ...rest }, link: null } } })
  expect(within(tree).getByText('read only, not enabled')).toBeVisible()
  expect(await screen.findByRole('table', { name: 'Device left/gripper' })).toHaveTextContent('not activated')
  expect(screen.getByRole('button', { name: 'Enable left/gripper…' })).toBeEnabled()
})

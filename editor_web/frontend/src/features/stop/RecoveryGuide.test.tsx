/** The banner of a stopped cell and its guide: who sees what, and what each step asks of the server. */
import { act, screen, waitFor, within } from '@testing-library/react'
import { afterEach, expect, it, vi } from 'vitest'
import { live, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { ArmRecovery, CellStop } from '../../api/types'
import { openGuide } from './guide'
import { RecoveryGuide } from './RecoveryGuide'
import { StoppedBanner } from './StoppedBanner'

const ARM: ArmRecovery = {
  name: 'left',
  part: 'cube',
  kept: false,
  can_release: true,
  has_moved: false,
  home: 'left_home',
  home_names: ['left_home'],
  at_home: false,
  problem: '',
}
const RUN = { id: 'r1', behavior: 'behaviors/shift.yaml', seq: 7, path: 'root/grasp' }
const led = vi.fn<(where: string) => void>()

function stopped(told: Partial<CellStop> = {}): CellStop {
  const devices = [
    { name: 'left', status: 'at_rest', after_s: 0.42, reason: '' },
    { name: 'right', status: 'failed', after_s: 5, reason: 'it did not answer' },
  ] as const
  return {
    number: 3,
    phase: 'stopped',
    reason: 'smoke',
    since_unix_s: 0,
    devices,
    runs: [RUN],
    arms: [ARM],
    parts: 'open',
    real: [],
    ...told,
  }
}

const AT_REST = stopped().devices.slice(0, 1)

function guide(stop: CellStop, role = 'operator') {
  server().on('GET /cell/stop', stop)
  const socket = live({ stop }, role)
  const user = show(
    <>
      <StoppedBanner />
      <RecoveryGuide
        renderJog={(arm) => <p>jog panel of {arm}</p>}
        renderEnable={({ name }) => <button type="button">Enable {name}…</button>}
        onTeach={() => led('teach')}
        onRun={led}
        onBehavior={led}
      />
    </>,
  )
  return { user, socket }
}

function step(title: RegExp) {
  return screen.getByRole('button', { name: title })
}

afterEach(() => act(() => openGuide(false)))

it('says on every page that the cell is stopped and what each device did, in full', () => {
  guide(stopped())
  const banner = screen.getByRole('region', { name: 'Stopped cell' })
  expect(banner).toHaveTextContent('Cell stopped')
  expect(banner).toHaveTextContent('smoke')
  expect(banner).toHaveTextContent('left at rest after 0.4 s')
  expect(banner).toHaveTextContent('right has not confirmed that it is at rest: it did not answer')
})

it('is not there in a cell that is not stopped, and goes when the stop is closed', () => {
  const { socket } = guide(stopped())
  socket.tell({ k: 'stop', stop: null })
  expect(screen.queryByRole('region', { name: 'Stopped cell' })).toBeNull()
  expect(screen.queryByRole('region', { name: 'Recovery guide' })).toBeNull()
})

it('is closed and opened again', async () => {
  const { user } = guide(stopped())
  await user.click(screen.getByRole('button', { name: 'Recovery guide' }))
  expect(screen.getByRole('button', { name: 'Close the guide' })).toHaveAttribute('aria-expanded', 'true')
  await user.click(screen.getByRole('button', { name: 'Close the recovery guide' }))
  expect(screen.getByRole('button', { name: 'Recovery guide' })).toHaveAttribute('aria-expanded', 'false')
})

it('keeps what an arm holds', async () => {
  server().on('POST /cell/stop/arms/left/keep', {})
  const { user } = guide(stopped())
  await user.click(screen.getByRole('button', { name: 'Keep' }))
  expect(server().bodies('POST /cell/stop/arms/left/keep')).toEqual([{}])
})

it('asks before a tool opens', async () => {
  server().on('POST /cell/stop/arms/left/release_part', {})
  const { user } = guide(stopped())
  await user.click(screen.getByRole('button', { name: 'Release' }))
  const dialog = await screen.findByRole('dialog', { name: 'Let left release cube?' })
  expect(dialog).toHaveTextContent('the part falls')
  expect(server().bodies('POST /cell/stop/arms/left/release_part')).toEqual([])
  await user.click(within(dialog).getByRole('button', { name: 'Release' }))
  await waitFor(() => expect(server().bodies('POST /cell/stop/arms/left/release_part')).toEqual([{}]))
})

it('jogs an arm in place', async () => {
  const { user } = guide(stopped())
  await user.click(screen.getByRole('button', { name: 'Jog left' }))
  expect(screen.getByText('jog panel of left')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Open the page Teach' }))
  expect(led).toHaveBeenLastCalledWith('teach')
})

it('says after a reload why an arm did not go home', () => {
  guide(stopped({ arms: [{ ...ARM, problem: 'left/move_free: the table is in between' }] }))
  expect(screen.getByText('Failed: left/move_free: the table is in between')).toBeVisible()
})

it('says why an arm did not go home, and what to do', async () => {
  server().on(
    'POST /cell/stop/arms/left/home',
    new Refusal(409, { message: 'the table is in between', hint: 'jog the arm clear, then try again' }),
  )
  const { user } = guide(stopped())
  await user.click(screen.getByRole('button', { name: 'Go home' }))
  const dialog = await screen.findByRole('dialog', { name: 'Move left home?' })
  expect(dialog).toHaveTextContent('with cube')
  await user.click(within(dialog).getByRole('button', { name: 'Go home' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('the table is in between – jog the arm clear, then try again')
})

it('says what is missing where a cell has no home', () => {
  guide(stopped({ arms: [{ ...ARM, home: '' }] }))
  expect(screen.getByText(/save its joints as the entry left_home/)).toBeVisible()
  expect(screen.queryByRole('button', { name: 'Go home' })).toBeNull()
})

it('is not released while a device has not confirmed rest', () => {
  guide(stopped())
  expect(screen.getByRole('button', { name: 'Release the stop' })).toBeDisabled()
  expect(screen.getByText(/Not possible: right has not confirmed/)).toBeVisible()
})

it('is released after saying what may move', async () => {
  server().on('POST /cell/stop/release', {})
  const { user } = guide(stopped({ devices: AT_REST }))
  await user.click(screen.getByRole('button', { name: 'Release the stop' }))
  const dialog = await screen.findByRole('dialog', { name: 'Release the stop of the cell?' })
  expect(dialog).toHaveTextContent('Runs may move left')
  expect(dialog).toHaveTextContent('left still holds cube')
  await user.click(within(dialog).getByRole('button', { name: 'Release the stop' }))
  await waitFor(() => expect(server().bodies('POST /cell/stop/release')).toEqual([{ stop: 3 }]))
})

it('resumes a run at the state in which it was stopped, or leaves it ended', async () => {
  server().on('POST /runs', { run: 'r2' }).on('POST /cell/stop/close', {})
  const { user } = guide(stopped({ phase: 'released', devices: AT_REST }))
  await user.click(screen.getByRole('button', { name: 'Resume' }))
  const dialog = await screen.findByRole('dialog', { name: 'Start shift at root/grasp?' })
  await user.click(within(dialog).getByRole('button', { name: 'Resume' }))
  await waitFor(() => expect(led).toHaveBeenLastCalledWith('r2'))
  expect(server().bodies('POST /runs')).toEqual([
    { behavior: 'behaviors/shift.yaml', parameters: {}, begin: { run: 'r1', seq: 7, path: 'root/grasp' } },
  ])
  await user.click(screen.getByRole('button', { name: 'Leave it ended' }))
  await waitFor(() => expect(server().bodies('POST /cell/stop/close')).toEqual([{}]))
})

it('lets a viewer see the steps and press none', () => {
  guide(stopped({ devices: AT_REST }), 'viewer')
  expect(screen.getByText(/somebody who is logged in as operator/)).toBeVisible()
  for (const name of ['Keep', 'Release', 'Jog left', 'Go home', 'Reset parts', 'Release the stop']) {
    expect(screen.getByRole('button', { name })).toBeDisabled()
  }
})

it('shows the state of each step, and those that are not needed folded', () => {
  guide(stopped({ devices: AT_REST, arms: [{ ...ARM, part: '' }] }))
  expect(step(/Everything at rest.*done/)).toHaveAttribute('aria-expanded', 'false')
  expect(step(/What the arms hold.*not needed/)).toHaveAttribute('aria-expanded', 'false')
  expect(step(/Go home.*open/)).toHaveAttribute('aria-expanded', 'true')
})

it('is asked for over HTTP while the live stream is down', async () => {
  const { socket } = guide(stopped())
  server().on('GET /cell/stop', stopped({ phase: 'released', devices: AT_REST }))
  socket.cut()
  expect(await screen.findByText('The stop is released')).toBeVisible()
})

it('offers to enable the real devices that may not move, and says why they may not', () => {
  const real = [
    { name: 'left', connected: true, enabled: false, problem: 'protective stop' },
    { name: 'left/gripper', connected: true, enabled: true, problem: '' },
  ]
  guide(stopped({ devices: AT_REST, real }))
  expect(step(/Enable real devices/)).toHaveTextContent('open: left: may not move')
  expect(screen.getByRole('group', { name: 'left/gripper' })).toHaveTextContent('may move')
  expect(screen.getByText(/may not move: protective stop/)).toBeVisible()
  expect(screen.getAllByRole('button', { name: /^Enable .*…$/ })).toHaveLength(1)
})

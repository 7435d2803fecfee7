/** How a run failed: where it began, why, what to do, and the way to the moment. */
import { act, screen, waitFor, within } from '@testing-library/react'
import { afterEach, expect, it, vi } from 'vitest'
import { live, robot, run, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { forget, useTimeline } from '../../api/timeline'
import type { RunComparison, RunFailure } from '../../api/types'
import { FailureView } from './FailureView'

const FAILED = run({ status: 'finished', outcome: 'bad' })
const FAILURE: RunFailure = {
  seq: 9,
  entered_seq: 7,
  time_s: 1.5,
  path: 'root/grasp',
  text: 'root/grasp failed: no contact',
  hint: 'look at the gripper',
  links: [
    {
      message: 'no contact on either pad',
      where: 'left/gripper/gripper_grasp',
      kind: 'GraspFailed',
      skill: 'left gripper: grasp',
      compared: [{ quantity: 'opening', measured: 1.2, unit: 'mm', least: 20, most: 40 }],
    },
    { message: 'the grasp failed', where: '', kind: 'StateError', compared: [], skill: '' },
  ],
  steps: [
    { path: 'root', seq: 11, time_s: 1.6, kind: 'exited', level: 'error', text: 'ended with bad', causes: [] },
    { path: 'root/grasp', seq: 9, time_s: 1.5, kind: 'exited', level: 'error', text: 'failed', causes: [] },
  ],
  around: [{ seq: 8, time_s: 1.4, kind: 'log', level: 'info', path: 'root/grasp', text: 'closes', causes: [] }],
}
const chosen = vi.fn()
const edited = vi.fn()
const asked = vi.fn()
const started = vi.fn()
const PAGE = { behavior: 'behaviors/shift.yaml', mayOperate: true, hasView: true, onEdit: edited, onParameters: asked, onStarted: started }

afterEach(() => {
  act(forget)
  act(() => useTimeline.setState(useTimeline.getInitialState(), true))
})

/** The server of a run that failed, and of no run before it that succeeded. */
function failing() {
  return server().on('GET /runs/r1/failure', FAILURE).on('GET /runs/r1/last-good-run', null)
}

function sections(): Record<string, string[]> {
  const region = within(screen.getByRole('region', { name: 'How the run failed' }))
  const lists = region.getAllByRole('list')
  const titles = region.getAllByRole('heading', { level: 4 })
  // Without a good run there is no list of what differs from it, and what was measured is a table.
  const others = new Set(['Against the last good run', 'Expected against measured'])
  const told = titles.filter((title) => !others.has(title.textContent ?? ''))
  return Object.fromEntries(
    told.map((title, at) => [
      title.textContent ?? '',
      within(lists[at] ?? document.body)
        .getAllByRole('listitem')
        .map((each) => each.textContent ?? ''),
    ]),
  )
}

it('tells where it began, why, and what happened there', async () => {
  failing()
  live({ runs: [FAILED] })
  show(<FailureView run={FAILED} page={PAGE} onShow={chosen} />)
  expect(await screen.findByText('root/grasp failed: no contact')).toBeVisible()
  expect(screen.getByText('It began in root/grasp at 1.50 s')).toBeVisible()
  expect(screen.getByText('look at the gripper')).toBeVisible()
  expect(sections()).toEqual({
    Why: ['left gripper: grasp: no contact on either padGraspFailed · left/gripper/gripper_grasp', 'so the grasp failedStateError'],
    Where: ['root ended with bad at 1.60 s', 'grasp failed at 1.50 s'],
    'What happened there': ['1.40 s closes'],
  })
})

it('tells what was measured against what was expected', async () => {
  failing()
  live({ runs: [FAILED] })
  show(<FailureView run={FAILED} page={PAGE} onShow={chosen} />)
  const table = await screen.findByRole('table', { name: 'Expected against measured' })
  expect(
    within(table)
      .getAllByRole('cell')
      .map((each) => each.textContent),
  ).toEqual(['opening', '20 to 40 mm', '1.2 mm', '18.8 mm too small'])
})

it('tells what differs from the last good run', async () => {
  const past = { ...FAILED, document: 'd', events: 9 }
  const comparison: RunComparison = {
    left: { ...past, id: 'r0', success: true },
    right: past,
    divergence: {
      kind: 'outcome',
      path: 'root/grasp',
      index: 1,
      left_s: 1,
      right_s: 1.5,
      text: 'root/grasp ended with missed, with held before',
    },
    visits: [],
    left_out: 0,
    nodes: [],
    settings: [{ at: 'parameters.dwell', left: '0.0', right: '2.0' }],
    documents: [],
    data: [],
    data_left_out: 0,
    icons: {},
  }
  failing().on('GET /runs/r1/last-good-run', comparison.left).on('GET /past-runs/comparison', comparison)
  live({ runs: [FAILED] })
  show(<FailureView run={FAILED} page={PAGE} onShow={chosen} />)
  expect(await screen.findByText('root/grasp ended with missed, with held before')).toBeVisible()
  expect(screen.getByText('parameters.dwell: 0.0 before, 2.0 now')).toBeVisible()
})

it('starts again where it failed, with what the run had there', async () => {
  started.mockReset()
  failing()
    .on('GET /runs/r1/events', {
      events: [
        { event: 'run_started', seq: 1, time_s: 0, behavior: 'shift', document: 'd', parameters: {}, seed: 5, clock: 'real', inputs: {} },
      ],
      last: 1,
    })
    .on('POST /runs', { run: 'r2' })
  live({ runs: [FAILED] })
  const user = show(<FailureView run={FAILED} page={PAGE} onShow={chosen} />)
  await user.click(await screen.findByRole('button', { name: 'Retry from here' }))
  await waitFor(() => expect(started.mock.calls).toEqual([['r2']]))
  expect(server().bodies('POST /runs')).toEqual([
    { behavior: 'behaviors/shift.yaml', seed: 5, begin: { run: 'r1', seq: 7, path: 'root/grasp' } },
  ])
})

it('turns the camera to what it names, opens the state, and leads to the parameters', async () => {
  failing()
  const socket = live({ runs: [FAILED], robots: { left: robot() } })
  const user = show(<FailureView run={FAILED} page={PAGE} onShow={chosen} />)
  await user.click(await screen.findByRole('button', { name: 'Show place in 3D' }))
  expect(socket.sent.at(-1)).toMatchObject({ k: 'look', names: expect.arrayContaining(['left']) as unknown })
  await user.click(screen.getByRole('button', { name: 'Open state' }))
  await user.click(screen.getByRole('button', { name: 'Change parameters' }))
  expect([edited.mock.calls, asked.mock.calls.length]).toEqual([[['root/grasp']], 1])
})

it('offers nothing that moves something while a run is active, and nothing to a viewer', async () => {
  failing()
  live({ runs: [FAILED, run({ id: 'r2' })] })
  show(<FailureView run={FAILED} page={PAGE} onShow={chosen} />)
  expect(await screen.findByRole('button', { name: 'Reset parts' })).toBeDisabled()
  expect(screen.getByRole('button', { name: 'Retry from here' })).toBeDisabled()
  show(<FailureView run={FAILED} page={{ ...PAGE, mayOperate: false }} onShow={chosen} />)
  await waitFor(() => expect(screen.getAllByRole('button', { name: 'Copy report' })).toHaveLength(2))
  expect(screen.getAllByRole('button', { name: 'Reset parts' })).toHaveLength(1)
})

it('leads to the node and the moment', async () => {
  chosen.mockReset()
  failing().on('GET /runs/r1/at', new Refusal(404, { message: 'gone' }))
  live({ runs: [FAILED] })
  const user = show(<FailureView run={FAILED} page={PAGE} onShow={chosen} />)
  await user.click(await screen.findByRole('button', { name: 'Show the moment' }))
  await waitFor(() => expect(chosen.mock.calls).toEqual([['root/grasp']]))
  expect(useTimeline.getState().timeS).toBe(1.5)
})

it.each([
  [undefined, null, 'No run yet'],
  [run(), null, 'The run is active'],
  [FAILED, null, 'This run did not fail'],
  [FAILED, new Refusal(404, { message: 'the journal has no such run' }), 'the journal has no such run'],
])('says what there is to tell of a run that has not failed', async (of, answer, words) => {
  server().on('GET /runs/r1/failure', answer)
  live()
  show(<FailureView run={of} page={PAGE} onShow={chosen} />)
  expect(await screen.findByText(words)).toBeVisible()
})

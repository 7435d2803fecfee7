/** The page of a sweep and the list of all: what they tell, and what one does there. */
import { act, screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { live, server, show } from '../../testing/page'
import { Refusal } from '../../testing/server'
import type { SweepLine, SweepLive, SweepRuns, SweepView, TrialResult } from '../api/types'
import { RerunLine } from '../features/sweeps/RerunLine'
import { SweepPage } from './SweepPage'
import { SweepsPage } from './SweepsPage'

const ID = 'behaviors/sweeps/transfer.yaml'
const AT = `/sweeps/${ID}`
const LIVE: SweepLive = {
  status: 'idle',
  planned: 10,
  done: 4,
  looked_at: 4,
  successes: 2,
  interval: [0.12, 0.88],
  verdict: 'undecided',
  rate_hz: 0,
  remaining_s: null,
  search: null,
  problem: '',
}
const LINE: SweepLine = {
  id: ID,
  description: 'Both arms',
  behavior: 'behaviors/transfer.yaml',
  design: 'random',
  require: 'success >= 0.9',
  towards: '',
  factors: ['parameters.speed', 'parameters.force'],
  live: LIVE,
  problem: '',
}
const ROW = { name: 'root/pick', runs: 4, least: 1, middle: 2, p95: 3, most: 4 }
const opened = vi.fn()

function trial(number: number, success: boolean): TrialResult {
  return {
    configuration: { number, seed: 40 + number, values: { 'parameters.speed': 0.1 * number, 'parameters.force': 10 - number } },
    status: 'finished',
    outcome: success ? 'done' : 'missed',
    success,
    cause: success ? '' : 'cup: it slipped',
    reason: success ? '' : 'it slipped',
    reason_at: success ? '' : 'cup',
    duration_s: number,
    events: 12,
    events_sha256: 'abcdef0123456789',
    nodes: { 'root/pick': { visits: 1, total_s: 2.5 } },
    outputs: {},
    measures: { 'left.path_m': 2.125 },
    covered: '',
    wall_s: 1,
    cpu_s: 1,
    memory_bytes: 1,
  }
}

const RUNS: SweepRuns = { runs: [trial(1, false), trial(3, false), trial(0, true), trial(2, true)], total: 4, alike: [[1, 3]] }
const VIEW: SweepView = {
  line: LINE,
  document: { flexcell: 1, behavior: '../behaviors/transfer.yaml', require: 'success >= 0.9' },
  curve: [
    { runs: 1, rate: 1, interval: [0.1, 1] },
    { runs: 4, rate: 0.5, interval: [0.12, 0.88] },
  ],
  subject: 'f00',
  versions: {},
  planned: 10,
  done: 4,
  looked_at: 4,
  successes: 2,
  interval: [0.12, 0.88],
  requirements: [],
  verdict: 'undecided',
  ended_by: 'interrupted',
  outcomes: [
    { label: 'done', runs: 2, interval: [0.1, 0.9], success: true },
    { label: 'missed', runs: 2, interval: [0.1, 0.9], success: false },
  ],
  causes: [{ at: 'cup', message: 'it slipped', runs: 2, examples: [1, 3] }],
  duration_s: { ...ROW, name: 'run' },
  nodes: [ROW],
  outputs: [],
  measures: [{ name: 'left.path_m', successes: ROW, failures: null }],
  effects: [
    {
      address: 'parameters.speed',
      with_success: -0.5,
      with_duration: null,
      levels: [{ label: '0 to 0.3', runs: 4, interval: [0.1, 0.9], successes: 2 }],
    },
  ],
  inputs: {
    factors: [{ address: 'parameters.speed', parts: 10, covered: 4, gap: [0.3, 0.9], gap_share: 0.6 }],
    pairs: [{ first: 'parameters.speed', second: 'parameters.force', parts: 100, covered: 4 }],
  },
  items: 9,
  missing: [{ kind: 'outcome', path: 'root/pick', name: 'lost', target: 'failed', file: 'a', line: 1, column: 1 }],
  cpu_s: 4,
}

beforeEach(() => {
  opened.mockReset()
  history.replaceState(null, '', AT)
  server().on(`GET ${AT}`, VIEW).on(`GET ${AT}/runs`, RUNS)
  for (const each of RUNS.runs) {
    const at = `GET ${AT}/runs/${each.configuration.number}`
    server().on(at, each).on(`${at}/shrinking`, { status: 'idle', progress: null, found: null, saved_as: '', problem: '' })
  }
})

async function page() {
  const socket = live()
  const user = show(<SweepPage id={ID} onOpen={opened} />)
  await screen.findByRole('heading', { name: 'transfer' })
  return { user, socket }
}

function numbers(): (string | null)[] {
  return within(screen.getByRole('group', { name: 'Table of runs' }))
    .getAllByRole('rowheader')
    .map((each) => each.textContent)
}

it('tells the rate with its interval, the verdict, causes, factors and what was never executed', async () => {
  await page()
  expect(screen.getByText('50.0 %', { selector: 'strong' })).toBeVisible()
  expect(screen.getByText(/the rate is 12.0 % to 88.0 %/)).toBeVisible()
  expect(screen.getByText('Undecided: at least 90.0 %')).toBeVisible()
  expect(screen.getByRole('img', { name: 'Success rate after each of 4 runs; at the end 50.0 %, interval 12.0 % to 88.0 %' })).toBeVisible()
  expect(screen.getByText('correlation with success −0.50')).toBeVisible()
  expect(screen.getByRole('rowheader', { name: 'left.path_m' })).toBeVisible()
  expect(screen.getByText('4 of 10 parts have a run; none from 0.3 to 0.9 (60.0 %)')).toBeVisible()
  expect(screen.getByText(/with parameters.force: 4 of 100/)).toBeVisible()
  expect(screen.getByText('8 of 9 nodes and exits of the behavior were executed.')).toBeVisible()
  expect(screen.getByRole('list', { name: 'Never executed' })).toHaveTextContent('outcome root/pick —lost→ failed')
})

it('lists failing runs first, sorts them, and shows those of a cause', async () => {
  const { user } = await page()
  expect(numbers()).toEqual(['#1', '#3', '#0', '#2'])
  await user.click(screen.getByRole('button', { name: 'Run' }))
  expect(numbers()).toEqual(['#0', '#1', '#2', '#3'])
  await user.click(screen.getByRole('button', { name: 'Run' }))
  expect(screen.getByRole('columnheader', { name: 'Run' })).toHaveAttribute('aria-sort', 'descending')
  await user.click(screen.getByRole('button', { name: /^2 runs it slipped/ }))
  expect(screen.getByRole('region', { name: 'Runs with this cause: 2' })).toBeVisible()
  expect(numbers()).toEqual(['#1', '#3'])
  await user.click(screen.getByRole('button', { name: 'Show all runs' }))
  expect(numbers()).toHaveLength(4)
})

it('chooses a run among the points by the keyboard alone', async () => {
  const { user } = await page()
  const points = screen.getByRole('listbox', { name: 'Runs by parameters.speed and parameters.force' })
  points.focus()
  await user.keyboard('{Home}{ArrowRight}')
  expect(points).toHaveAttribute('aria-activedescendant', screen.getByRole('option', { name: /^Run 1: missed/ }).id)
  await user.keyboard('{Enter}')
  expect(location.hash).toBe('#1')
  expect(await screen.findByRole('region', { name: 'Run 1' })).toHaveTextContent('cup: it slipped')
  await user.selectOptions(screen.getByRole('combobox', { name: 'Upwards' }), 'duration')
  expect(screen.getByRole('listbox', { name: 'Runs by parameters.speed and duration' })).toBeVisible()
})

it('opens the run of the address, and the run itself once it was the same again', async () => {
  history.replaceState(null, '', `${AT}#3`)
  const told = { recording: '.flexcell/sweep-runs/t-3.mcap', same: true, result: trial(3, false), saved: trial(3, false) }
  server().on(`POST ${AT}/runs/3/recording`, told)
  const { user } = await page()
  await user.click(await screen.findByRole('button', { name: 'Open with graph, timeline and 3D' }))
  await waitFor(() => expect(opened.mock.calls).toEqual([['/recordings/.flexcell/sweep-runs/t-3.mcap']]))
  show(<RerunLine recording={told.recording} href={() => '#'} onOpen={opened} />)
  expect(screen.getByText(/the same 12 events as in the sweep/)).toHaveTextContent('sha256 abcdef012345')
})

it('says so where a run was not the same again, and opens it only if one wants', async () => {
  history.replaceState(null, '', `${AT}#3`)
  const result = { ...trial(3, true), events: 15 }
  server().on(`POST ${AT}/runs/3/recording`, { recording: 'a.mcap', same: false, result, saved: trial(3, false) })
  const { user } = await page()
  await user.click(await screen.findByRole('button', { name: 'Open with graph, timeline and 3D' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('It ended differently this time: done with 15 events, before missed with 12.')
  expect(opened).not.toHaveBeenCalled()
  await user.click(screen.getByRole('button', { name: 'Open it anyway' }))
  expect(opened.mock.calls).toEqual([['/recordings/a.mcap']])
})

it('starts what is left, follows it by the live stream, and stops it', async () => {
  server().on(`POST ${AT}/start`, undefined).on(`POST ${AT}/stop`, undefined)
  const { user, socket } = await page()
  await user.click(screen.getByRole('button', { name: 'Go on with 6 runs' }))
  await waitFor(() => expect(server().bodies(`POST ${AT}/start`)).toEqual([{ again: false }]))
  socket.tell({ k: 'sweeps', changed: { [ID]: { ...LIVE, status: 'running', done: 5, rate_hz: 1, remaining_s: 5 } } })
  expect(screen.getByText(/60 runs\/min, 5 s left at most/)).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Stop the sweep' }))
  await waitFor(() => expect(server().bodies(`POST ${AT}/stop`)).toHaveLength(1))
  socket.tell({ k: 'sweeps', changed: { [ID]: { ...LIVE, done: 5, problem: 'its process has ended' } } })
  expect(screen.getByRole('alert')).toHaveTextContent('its process has ended')
  await waitFor(() => expect(server().asked.filter((each) => each.what === `GET ${AT}`).length).toBeGreaterThan(1))
})

it('offers a viewer nothing that starts anything', async () => {
  history.replaceState(null, '', `${AT}#3`)
  live({}, 'viewer')
  show(<SweepPage id={ID} onOpen={opened} />)
  expect(await screen.findByRole('region', { name: 'Run 3' })).toBeVisible()
  expect(screen.queryByRole('button', { name: /Go on|Open with/ })).toBeNull()
})

it('says why a sweep cannot be read', async () => {
  server().on(`GET ${AT}`, new Refusal(404, { message: 'there is no sweep', hint: 'see the list' }))
  live()
  show(<SweepPage id={ID} onOpen={opened} />)
  expect(await screen.findByText(/there is no sweep – see the list/)).toBeVisible()
})

it('lists sweeps as they are now, what is wrong with one, and results of none', async () => {
  const broken: SweepLine = { ...LINE, id: 'sweeps/broken.yaml', description: '', problem: 'there is no behavior' }
  server().on('GET /sweeps', { sweeps: [LINE, broken], others: [{ subject: 'abcdef0123456789', behavior: '', runs: 7, successes: 5 }] })
  const socket = live()
  const user = show(<SweepsPage onOpen={opened} />)
  const [first, second] = await screen.findAllByRole('listitem')
  expect(first).toHaveTextContent('4 of 10 runs50.0 % succeeded (12.0 % to 88.0 %)')
  expect(second).toHaveTextContent('there is no behavior')
  expect(screen.getByRole('list', { name: 'Results of no sweep here' })).toHaveTextContent('7 runs, 5 succeeded')
  socket.tell({ k: 'sweeps', changed: { [ID]: { ...LIVE, status: 'running', done: 9 } } })
  expect(first).toHaveTextContent('9 of 10 runs')
  await user.click(screen.getByRole('link', { name: 'transfer' }))
  expect(opened.mock.calls).toEqual([[AT]])
})

it('makes and starts a sweep of what the form says', async () => {
  const choices = [{ address: 'parameters.speed', nominal: 0.5, unit: '', description: 'Share', least: 0.1, most: 1, options: [] }]
  server()
    .on('GET /sweeps', { sweeps: [LINE], others: [] })
    .on('GET /behaviors', [
      { id: 'behaviors/transfer.yaml', name: 'transfer', description: '', errors: 0, warnings: 0, fit: { cell: '', obstacle: '' } },
    ])
    .on('GET /sweep-factors', choices)
    .on('POST /sweeps', new Refusal(422, { message: 'the cell has no part', hint: '' }))
    .on('POST /sweeps/behaviors/sweeps/transfer_2.yaml/start', undefined)
  live()
  const user = show(<SweepsPage onOpen={opened} />)
  await user.click(await screen.findByRole('button', { name: 'New sweep' }))
  await user.click(screen.getByRole('button', { name: 'Create and start' }))
  expect(screen.getByRole('alert')).toHaveTextContent('Choose a behavior')
  await user.selectOptions(
    await screen.findByRole('combobox', { name: 'Behavior' }),
    await screen.findByRole('option', { name: 'transfer.yaml' }),
  )
  await user.type(screen.getByLabelText('Required success rate, %'), '95')
  await user.click(screen.getByRole('button', { name: 'Add a factor' }))
  await act(() => new Promise((resolve) => setTimeout(resolve)))
  await user.click(screen.getByLabelText('What is varied'))
  await user.paste('parameters.speed')
  expect(screen.getByLabelText('Least value of parameters.speed')).toHaveValue('0.1')
  await user.click(screen.getByRole('button', { name: 'Create and start' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('the cell has no part')
  server().on('POST /sweeps', { id: 'behaviors/sweeps/transfer_2.yaml' })
  await user.click(screen.getByRole('button', { name: 'Create and start' }))
  await waitFor(() => expect(opened.mock.calls).toEqual([['/sweeps/behaviors/sweeps/transfer_2.yaml']]))
  expect(server().bodies('POST /sweeps').at(-1)).toEqual({
    id: 'behaviors/sweeps/transfer_2.yaml',
    document: {
      flexcell: 1,
      behavior: 'behaviors/transfer.yaml',
      runs: 100,
      require: 'success >= 0.95',
      factors: { 'parameters.speed': { uniform: [0.1, 1] } },
    },
  })
})

it('makes a search for failures of what the form says', async () => {
  server()
    .on('GET /sweeps', { sweeps: [], others: [] })
    .on('GET /behaviors', [
      { id: 'behaviors/transfer.yaml', name: 'transfer', description: '', errors: 0, warnings: 0, fit: { cell: '', obstacle: '' } },
    ])
    .on('GET /sweep-factors', [])
    .on('POST /sweeps', { id: ID })
  live()
  const user = show(<SweepsPage onOpen={opened} />)
  await user.click(await screen.findByRole('button', { name: 'New sweep' }))
  await user.selectOptions(
    await screen.findByRole('combobox', { name: 'Behavior' }),
    await screen.findByRole('option', { name: 'transfer.yaml' }),
  )
  await user.selectOptions(screen.getByRole('combobox', { name: 'To find out' }), 'how it fails: a search for failures')
  expect(screen.queryByLabelText('Required success rate, %')).toBeNull()
  await user.selectOptions(screen.getByRole('combobox', { name: 'Towards' }), 'the least of a number')
  await user.click(screen.getByLabelText('Number'))
  await user.paste('left.gripper.force_min_n')
  await user.click(screen.getByLabelText('Stop after, failures'))
  await user.paste('3')
  await user.click(screen.getByRole('button', { name: 'Add a factor' }))
  await user.click(screen.getByLabelText('What is varied'))
  await user.paste('parameters.speed')
  await user.click(screen.getByLabelText('Least value of parameters.speed'))
  await user.paste('0.1')
  await user.click(screen.getByLabelText('Greatest value of parameters.speed'))
  await user.paste('1')
  await user.click(screen.getByRole('button', { name: 'Make only' }))
  await waitFor(() => expect(opened.mock.calls).toEqual([[AT]]))
  expect(server().bodies('POST /sweeps')[0]).toMatchObject({
    document: {
      factors: { 'parameters.speed': { uniform: [0.1, 1] } },
      search: { towards: 'least left.gripper.force_min_n', method: 'cross_entropy', runs: 100, stop_after: 3 },
    },
  })
})

/** The page of a search for failures, a failing run of a sweep that is shrunk, and a sweep compared with a baseline. */
import { fireEvent, screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { live, server, show } from '../../testing/page'
import { Refusal } from '../../testing/server'
import type { Baseline, SearchView, Shrinking, Shrunk, SweepComparison, SweepLine, SweepLive, SweepRuns, TrialResult } from '../api/types'
import { BaselineChoice } from '../features/sweeps/BaselineChoice'
import { ShrinkRun } from '../features/sweeps/ShrinkRun'
import { SweepPage } from './SweepPage'

const ID = 'behaviors/sweeps/transfer.yaml'
const AT = `/sweeps/${ID}`
const SHRINKING = `${AT}/runs/3/shrinking`
const LIVE: SweepLive = {
  status: 'idle',
  planned: 20,
  done: 3,
  looked_at: 0,
  successes: 0,
  interval: null,
  verdict: null,
  rate_hz: 0,
  remaining_s: null,
  search: { failures: 2, nearest: 4.5, is_satisfied: false },
  problem: '',
}
const LINE: SweepLine = {
  id: ID,
  description: '',
  behavior: 'behaviors/transfer.yaml',
  design: 'random',
  require: '',
  towards: 'most duration_s',
  factors: ['parameters.speed'],
  live: LIVE,
  problem: '',
}
const opened = vi.fn()

function trial(number: number, success: boolean): TrialResult {
  return {
    configuration: { number, seed: 40 + number, values: { 'parameters.speed': 0.1 * number, 'parameters.force': 10 - number } },
    status: success ? 'finished' : 'errored',
    outcome: success ? 'done' : null,
    success,
    cause: success ? '' : 'cup: it slipped',
    reason: success ? '' : 'it slipped',
    reason_at: success ? '' : 'cup',
    duration_s: 4.5,
    events: 12,
    events_sha256: 'abcdef0123456789',
    nodes: {},
    outputs: {},
    measures: {},
    covered: '',
    wall_s: 1,
    cpu_s: 1,
    memory_bytes: 1,
  }
}

const FAILING = trial(3, false)
const RUNS: SweepRuns = { runs: [trial(1, false), FAILING, trial(0, true)], total: 3, alike: [[1, 3]] }
const VIEW: SearchView = {
  line: LINE,
  document: { flexcell: 1, behavior: '../transfer.yaml' },
  done: 3,
  failures: 2,
  towards: 'most duration_s',
  found: '2 of 3 runs failed.',
  method: 'Searched by cross-entropy.',
  likelihood: '32.5 % of all runs fail.',
  figure: '<svg role="img" aria-label="Near"><circle data-run="0"></circle><path data-run="3"></path></svg>',
  subject: 'f00',
  versions: {},
  spec: { towards: 'most duration_s' },
  target: { name: 'duration_s', sign: -1, guides: true },
  ended_by: 'interrupted',
  refused: 0,
  clusters: [
    {
      cause: { at: 'cup', message: 'it slipped', runs: 2, examples: [1, 3] },
      regions: [{ address: 'parameters.speed', listed: false, failing: [0.1, 0.3], executed: [0, 0.3], share: 0.2, passed_inside: 1 }],
    },
  ],
  nearest: [trial(0, true)],
  batches: [{ batch: 0, runs: 3, failures: 2, refused: 0, nearest: 4.5 }],
  probability: { estimate: 0.325, interval: [0.145, 0.642], effective_failures: 1.5 },
  cpu_s: 3,
}
const SHRUNK: Shrunk = {
  result: FAILING,
  changed: { 'parameters.speed': [0.1, 0.3] },
  runs: 7,
  passes: { 'parameters.speed': 0.25 },
  seed_matters: false,
  placement_noise: false,
  interrupted: false,
}
const NEVER: Shrinking = { status: 'idle', progress: null, found: null, saved_as: '', problem: '' }
const FOUND: Shrinking = { ...NEVER, found: { subject: 'f00', failing: FAILING.configuration, shrunk: SHRUNK } }

beforeEach(() => {
  opened.mockReset()
  history.replaceState(null, '', AT)
  server().on(`GET ${AT}`, VIEW).on(`GET ${AT}/runs`, RUNS).on(`GET ${AT}/runs/3`, FAILING).on(`GET ${SHRINKING}`, NEVER)
})

it('tells what a search has found, and no success rate', async () => {
  live()
  show(<SweepPage id={ID} onOpen={opened} />)
  expect(await screen.findByText('2 failures')).toBeVisible()
  expect(screen.getByText('nearest success: most duration_s 4.5')).toBeVisible()
  expect(screen.getByText(/search for failures towards most duration_s/)).toBeVisible()
  expect(screen.getByText('32.5 % of all runs fail.')).toBeVisible()
  const regions = within(screen.getByRole('group', { name: 'Where it fails: it slipped' }))
  expect(regions.getByRole('row', { name: /speed/ })).toHaveTextContent('parameters.speed0.1 to 0.30 to 0.320.0 %1')
  expect(screen.getByRole('group', { name: 'Table of the nearest successes' })).toHaveTextContent('#04.5')
  expect(screen.queryByText(/succeeded \(|Success rate/)).toBeNull()
})

it('chooses a run by its mark in the figure, and the runs of a cause', async () => {
  live()
  const user = show(<SweepPage id={ID} onOpen={opened} />)
  const figure = await screen.findByRole('group', { name: 'How near to failure each run was' })
  const mark = figure.querySelector('[data-run="3"]')
  if (!mark) throw new Error('the figure has no mark')
  fireEvent.click(mark)
  const details = await screen.findByRole('region', { name: 'Run 3' })
  await waitFor(() => expect(details).toHaveTextContent('cup: it slipped'))
  expect(figure.querySelector('[data-selected]')).toHaveAttribute('data-run', '3')
  await user.click(screen.getByRole('button', { name: /^2 runs it slipped/ }))
  expect(screen.getByRole('region', { name: 'Runs with this cause: 2' })).toBeVisible()
})

it('goes on with a search until it has found as many failures as it is for', async () => {
  server().on(`POST ${AT}/start`, undefined)
  const socket = live()
  const user = show(<SweepPage id={ID} onOpen={opened} />)
  await user.click(await screen.findByRole('button', { name: 'Go on with 17 runs' }))
  await waitFor(() => expect(server().bodies(`POST ${AT}/start`)).toEqual([{ again: false }]))
  socket.tell({
    k: 'sweeps',
    changed: { [ID]: { ...LIVE, status: 'running', done: 5, search: { failures: 1, nearest: null, is_satisfied: false } } },
  })
  expect(screen.getByText('1 failure')).toBeVisible()
  const satisfied = { ...LIVE, search: { failures: 3, nearest: 4.5, is_satisfied: true } }
  server().on(`GET ${AT}`, { ...VIEW, line: { ...LINE, live: satisfied } })
  socket.tell({ k: 'sweeps', changed: { [ID]: satisfied } })
  expect(await screen.findByText(/as many failures are found as it is for: no more are needed/)).toBeVisible()
  expect(screen.getByRole('button', { name: 'Go on with 17 runs' })).toHaveAttribute('aria-disabled', 'true')
})

function shrinkRun(mayOperate = true) {
  return show(<ShrinkRun sweep={ID} run={FAILING} subject="f00" mayOperate={mayOperate} onOpenSweep={opened} />)
}

it('shrinks a run, follows it, and saves what is left as a test case', async () => {
  const user = shrinkRun()
  await user.selectOptions(await screen.findByRole('combobox', { name: /as long as/ }), 'its root cause is the same too')
  server()
    .on(`POST ${SHRINKING}`, undefined)
    .on(`GET ${SHRINKING}`, {
      ...NEVER,
      status: 'running',
      progress: { runs: 4, most_runs: 200, step: 'round', changed: ['parameters.speed'] },
    })
  await user.click(screen.getByRole('button', { name: 'Shrink this run' }))
  expect(server().bodies(`POST ${SHRINKING}`)).toEqual([{ same: 'cause' }])
  expect(await screen.findByText('4 of at most 200 runs tried: round')).toBeVisible()
  expect(screen.getByText('parameters.speed')).toBeVisible()
  server().on(`GET ${SHRINKING}`, FOUND)
  const change = await screen.findByRole('group', { name: 'The smallest change from nominal' })
  expect(within(change).getByRole('row', { name: /speed/ })).toHaveTextContent('parameters.speed0.10.30.25')
  expect(screen.getByText('Found in 7 runs.')).toBeVisible()
  server().on(`POST ${SHRINKING}/case`, new Refusal(422, { message: 'there is a file already', hint: '' }))
  await user.click(screen.getByRole('button', { name: 'Save as a test case' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('there is a file already')
  server()
    .on(`POST ${SHRINKING}/case`, { id: 'tests/cases/a.yaml' })
    .on(`GET ${SHRINKING}`, { ...FOUND, saved_as: 'tests/cases/a.yaml' })
  await user.clear(screen.getByRole('textbox', { name: 'File of the test case' }))
  await user.type(screen.getByRole('textbox', { name: 'File of the test case' }), 'tests/cases/a.yaml')
  await user.click(screen.getByRole('button', { name: 'Save as a test case' }))
  await user.click(await screen.findByRole('button', { name: 'tests/cases/a.yaml' }))
  expect(server().bodies(`POST ${SHRINKING}/case`)).toEqual([{ id: 'tests/cases/transfer_3.yaml' }, { id: 'tests/cases/a.yaml' }])
  expect(opened.mock.calls).toEqual([['tests/cases/a.yaml']])
})

it('is followed further where it could not be read once', async () => {
  const progress = { runs: 4, most_runs: 200, step: 'round', changed: [] }
  server().on(`GET ${SHRINKING}`, { ...NEVER, status: 'running', progress })
  shrinkRun()
  await screen.findByText('4 of at most 200 runs tried: round')
  server().on(`GET ${SHRINKING}`, new Refusal(503, { message: 'too much to do', hint: '' }))
  expect(await screen.findByText('too much to do')).toBeVisible()
  server().on(`GET ${SHRINKING}`, FOUND)
  expect(await screen.findByRole('group', { name: 'The smallest change from nominal' })).toBeVisible()
  expect(screen.queryByText('too much to do')).toBeNull()
})

it('stops with the smallest so far, and says why nothing was found', async () => {
  server()
    .on(`GET ${SHRINKING}`, { ...NEVER, status: 'running' })
    .on(`POST ${SHRINKING}/stop`, undefined)
  const user = shrinkRun()
  server().on(`GET ${SHRINKING}`, { ...NEVER, problem: 'the sweep process has ended' })
  await user.click(await screen.findByRole('button', { name: 'Stop with the smallest so far' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('the sweep process has ended')
  expect(server().bodies(`POST ${SHRINKING}/stop`)).toHaveLength(1)
})

it('shows a viewer what was found, and offers him nothing', async () => {
  server().on(`GET ${SHRINKING}`, FOUND)
  shrinkRun(false)
  expect(await screen.findByRole('group', { name: 'The smallest change from nominal' })).toBeVisible()
  expect(screen.queryByRole('button')).toBeNull()
})

const BASELINE: Baseline = {
  results: '.flexcell/sweeps.db',
  version: { version: 'old', runs: 12, successes: 9, changed: ['behavior'], saved_unix_s: 1795658400 },
}
const COMPARED: SweepComparison = {
  comparison: {
    baseline: 'old',
    changed: ['behavior'],
    pair: { both: 6, only_first: 3, only_second: 1, neither: 2 },
    interval: [-0.5, 0.2],
    margin: null,
    broken: [4, 7],
  },
  verdict: null,
  words: 'not known to differ from the baseline',
}

it('compares with the newest baseline, and with what is required', async () => {
  const asked: (string | null)[] = []
  server()
    .on(`GET ${AT}/baselines`, [BASELINE, { ...BASELINE, version: { ...BASELINE.version, version: 'older' } }])
    .on(`GET ${AT}/comparison`, ({ query }: { query: URLSearchParams }) => {
      asked.push(`${query.get('version')} ${query.get('margin')}`)
      const isRequired = query.has('margin')
      return isRequired ? { ...COMPARED, comparison: { ...COMPARED.comparison, margin: 0.05 }, verdict: 'undecided' } : COMPARED
    })
  const user = show(<BaselineChoice sweep={ID} revision={12} onSelect={opened} />)
  await user.click(screen.getByRole('button', { name: 'Choose a baseline' }))
  const table = await screen.findByRole('group', { name: 'Table of both versions' })
  expect(table).toHaveTextContent('Baseline9 of 1275.0 %Now7 of 1258.3 %Difference−50.0 to +20.0 points−16.7')
  expect(screen.getByText('This version is not known to differ from the baseline.')).toBeVisible()
  await user.type(screen.getByLabelText('May be lower by, points'), 'x')
  await user.click(screen.getByRole('button', { name: 'Compare' }))
  expect(screen.getByRole('alert')).toHaveTextContent('The margin is 0 to 100 points')
  await user.clear(screen.getByLabelText('May be lower by, points'))
  await user.type(screen.getByLabelText('May be lower by, points'), '5')
  await user.selectOptions(screen.getByRole('combobox', { name: 'Baseline' }), '1')
  expect(await screen.findByText('Undecided')).toBeVisible()
  expect(asked).toEqual(['old null', 'older 0.05'])
  await user.click(screen.getByRole('button', { name: 'Run 7' }))
  expect(opened.mock.calls).toEqual([[7]])
})

it('says what to do where there is no baseline', async () => {
  server().on(`GET ${AT}/baselines`, [])
  const user = show(<BaselineChoice sweep={ID} revision={12} onSelect={opened} />)
  await user.click(screen.getByRole('button', { name: 'Choose a baseline' }))
  expect(await screen.findByText(/No other version has executed these runs/)).toBeVisible()
})

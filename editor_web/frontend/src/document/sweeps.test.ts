/** What a sweep has shown, in words, orders and scales. */
import { expect, it } from 'vitest'
import type { FactorChoice, SweepLine, SweepLive, SweepView, TrialResult } from '../api/types'
import {
  alikeOf,
  axisScale,
  coverageText,
  currentLive,
  documentOf,
  factorOf,
  orderedRuns,
  percent,
  proposedFactor,
  proposedId,
  quantileGroups,
  requiredRate,
  requiredText,
  scatterAxes,
  speedText,
  type FactorDraft,
  type SearchDraft,
} from './sweeps'

const LIVE: SweepLive = {
  status: 'idle',
  planned: 10,
  done: 4,
  looked_at: 4,
  successes: 3,
  interval: [0.2, 0.9],
  verdict: null,
  rate_hz: 0,
  remaining_s: null,
  search: null,
  problem: '',
}
const LINE: SweepLine = {
  id: 's.yaml',
  description: '',
  behavior: 'b.yaml',
  design: 'random',
  require: '',
  towards: '',
  factors: [],
  live: LIVE,
  problem: '',
}
const CHOICE: FactorChoice = { address: 'parameters.speed', nominal: 0.5, unit: '', description: '', least: 0.05, most: 1, options: [] }
const DRAFT: FactorDraft = { address: 'parameters.speed', kind: 'uniform', first: '0.1', second: '0.9', values: '' }

function run(
  number: number,
  changes: Partial<TrialResult> = {},
  values: Record<string, unknown> = { x: number / 10, part: 'bolt' },
): TrialResult {
  return {
    configuration: { number, seed: number, values },
    status: 'finished',
    outcome: 'done',
    success: true,
    cause: '',
    reason: '',
    reason_at: '',
    duration_s: 1 + number,
    events: 9,
    events_sha256: 'a',
    nodes: {},
    outputs: {},
    measures: {},
    covered: '',
    wall_s: 1,
    cpu_s: 1,
    memory_bytes: 1,
    ...changes,
  }
}

it('never calls everything what is not quite everything', () => {
  expect([percent(1), percent(0.99999), percent(0.5), percent(0)]).toEqual(['100.0 %', '> 99.9 %', '50.0 %', '0.0 %'])
})

it('believes the stream while a sweep is executed, and what was read otherwise', () => {
  const running: SweepLive = { ...LIVE, status: 'running', done: 7 }
  expect(currentLive(LINE, running)).toBe(running)
  expect(currentLive(LINE, undefined)).toEqual(LIVE)
  expect(currentLive(LINE, { ...LIVE, done: 2, problem: 'its process has ended' })).toEqual({ ...LIVE, problem: 'its process has ended' })
})

it('tells the speed and what is left at most', () => {
  expect(speedText({ ...LIVE, rate_hz: 0.68333, remaining_s: 530 })).toBe('41 runs/min, 9 min left at most')
  expect(speedText({ ...LIVE, rate_hz: 1, remaining_s: 0, done: 10 })).toBe('60 runs/min')
  expect(speedText(LIVE)).toBe('')
})

it('reads what is required', () => {
  expect(requiredRate('success >= 0.98')).toBe(0.98)
  expect(requiredRate('')).toBeUndefined()
  expect(requiredRate(undefined)).toBeUndefined()
  const limit = 'share(cell.contact_force_max_n <= 30) >= 0.95'
  expect(requiredRate(limit)).toBeUndefined()
  expect(requiredRate(['success >= 0.9', limit, 'success >= 0.98'])).toBe(0.98)
  expect(requiredRate(`success >= 0.9; ${limit}`)).toBe(0.9)
  expect(requiredText('success >= 0.98')).toBe('at least 98.0 %')
  expect(requiredText(limit)).toBe(limit)
  expect(requiredText(`success >= 0.9; ${limit}`)).toBe(`success >= 0.9; ${limit}`)
})

it('finds every distribution of a summary, also one that it has no name for', () => {
  const row = { name: 'force_n', runs: 3, least: 1, middle: 2, p95: 3, most: 4 }
  const spread = { name: 'left.force_max_n', successes: row, failures: row }
  const view = { ...LINE, done: 4, duration_s: row, nodes: [row, row], measures: [spread, { ...spread, failures: null }], outputs: [] }
  const found = quantileGroups(view as unknown as SweepView)
  expect(found.map((group) => [group.title, group.rows.map((each) => each.name)])).toEqual([
    ['Duration of runs that succeeded, s', ['force_n']],
    ['Time in each node, s', ['force_n', 'force_n']],
    ['Measures of runs that succeeded, and of those that failed', ['left.force_max_n', 'left.force_max_n, failed', 'left.force_max_n']],
  ])
})

it('tells how much of a factor the runs have covered', () => {
  const factor = { address: 'x', parts: 10, covered: 7, gap: [0.5, 0.8] as const, gap_share: 0.3 }
  expect(coverageText(factor)).toBe('7 of 10 parts have a run; none from 0.5 to 0.8 (30.0 %)')
  expect(coverageText({ ...factor, gap: null, gap_share: null })).toBe('7 of 10 parts have a run')
})

it('lists failing runs first, and runs in any other order', () => {
  const runs = [
    run(0),
    run(1, { success: false, outcome: 'missed' }),
    run(2, { success: false, outcome: null, status: 'errored' }),
    run(10),
  ]
  const numbers = (by: string, isFalling = false) => orderedRuns(runs, { by, isFalling }).map((each) => each.configuration.number)
  expect(numbers('ended')).toEqual([2, 1, 0, 10])
  expect(numbers('number', true)).toEqual([10, 2, 1, 0])
  expect(numbers('duration')).toEqual([0, 1, 2, 10])
  expect(numbers('x', true)).toEqual([10, 2, 1, 0])
  expect(numbers('part')).toEqual([0, 1, 2, 10])
})

it('finds the runs with the same cause', () => {
  const runs = { runs: [], total: 0, alike: [[1, 4, 9], [3]] }
  expect([...alikeOf(runs, 4)]).toEqual([1, 4, 9])
  expect(alikeOf(runs, undefined).size).toBe(0)
  expect(alikeOf(runs, 7).size).toBe(0)
})

it('draws runs over what varies, numbers first', () => {
  const runs = [
    run(0, {}, { part: 'nut', fixed: 1, x: 2 }),
    run(1, {}, { part: 'bolt', fixed: 1, x: 4 }),
    run(2, {}, { part: 'bolt', fixed: 1, x: 3 }),
  ]
  expect(scatterAxes(runs, ['fixed', 'part', 'x'])).toEqual(['x', 'part', 'duration'])
  expect(scatterAxes([], [])).toEqual(['duration'])
  const numbers = axisScale(runs, 'x')
  expect(runs.map(numbers.of)).toEqual([0, 1, 0.5])
  expect(numbers.marks.map((mark) => mark.label)).toEqual(['2', '3', '4'])
  const names = axisScale(runs, 'part')
  expect(runs.map(names.of)).toEqual([0.75, 0.25, 0.25])
  expect(names.marks.map((mark) => mark.label)).toEqual(['bolt', 'nut'])
})

it('proposes a distribution for what is varied', () => {
  expect(proposedFactor(CHOICE)).toMatchObject({ kind: 'uniform', first: '0.05', second: '1' })
  expect(proposedFactor({ ...CHOICE, address: 'displace.bolt.x_m', nominal: 0, least: null, most: null })).toMatchObject({
    kind: 'normal',
    first: '0',
    second: '0.005',
  })
  expect(proposedFactor({ ...CHOICE, address: 'cell.parts.bolt.mass_kg', nominal: -2, least: null, most: null })).toMatchObject({
    kind: 'uniform',
    first: '-2.4',
    second: '-1.6',
  })
  expect(proposedFactor({ ...CHOICE, options: [true, 'a'] })).toMatchObject({ kind: 'values', values: 'true, "a"' })
  expect(proposedFactor({ ...CHOICE, nominal: 'miss', least: null, most: null })).toMatchObject({ kind: 'values', values: '"miss"' })
})

it.each([
  [DRAFT, { uniform: [0.1, 0.9] }],
  [{ ...DRAFT, kind: 'log_uniform' }, { log_uniform: [0.1, 0.9] }],
  [{ ...DRAFT, kind: 'normal', first: '0', second: '0.2' }, { normal: { mean: 0, deviation: 0.2 } }],
  [{ ...DRAFT, kind: 'values', values: '1, "a", none ,' }, { values: [1, 'a', 'none'] }],
  [{ ...DRAFT, first: '' }, 'parameters.speed needs two numbers'],
  [{ ...DRAFT, first: '2' }, 'parameters.speed goes from the least to the greatest value'],
  [{ ...DRAFT, kind: 'normal', second: '0' }, 'the deviation of parameters.speed is above 0'],
  [{ ...DRAFT, kind: 'values' }, 'parameters.speed needs values'],
  [{ ...DRAFT, address: '' }, 'A factor needs a name'],
] as const)('reads a factor of a form: %j', (draft, expected) => {
  expect(factorOf(draft)).toEqual(expected)
})

it('makes the document of a form, or says what is wrong', () => {
  const draft = { id: '', behavior: 'behaviors/a.yaml', runs: '20', required: '98', factors: [DRAFT], search: undefined }
  expect(documentOf(draft)).toEqual({
    flexcell: 1,
    behavior: 'behaviors/a.yaml',
    runs: 20,
    require: 'success >= 0.98',
    factors: { 'parameters.speed': { uniform: [0.1, 0.9] } },
  })
  expect(documentOf({ ...draft, required: '', factors: [] })).toEqual({ flexcell: 1, behavior: 'behaviors/a.yaml', runs: 20, factors: {} })
  expect(documentOf({ ...draft, behavior: '' })).toBe('Choose a behavior')
  expect(documentOf({ ...draft, runs: '1.5' })).toBe('Runs are a whole number, 1 at least')
  expect(documentOf({ ...draft, required: '101' })).toBe('The required success rate is 0 to 100 %')
  expect(documentOf({ ...draft, factors: [DRAFT, DRAFT] })).toBe('parameters.speed is there twice')
})

it('makes the document of a search, which requires no rate', () => {
  const search: SearchDraft = { towards: 'most', name: ' duration_s ', method: 'cross_entropy', stopAfter: '3' }
  const draft = { id: '', behavior: 'behaviors/a.yaml', runs: '20', required: '98', factors: [DRAFT], search }
  const factors = { 'parameters.speed': { uniform: [0.1, 0.9] } }
  const spec = { towards: 'most duration_s', method: 'cross_entropy', runs: 20, stop_after: 3 }
  expect(documentOf(draft)).toEqual({ flexcell: 1, behavior: 'behaviors/a.yaml', factors, search: spec })
  expect(documentOf({ ...draft, search: { ...search, towards: 'failure', stopAfter: '' } })).toMatchObject({
    search: { towards: 'failure', runs: 20 },
  })
  expect(documentOf({ ...draft, search: { ...search, name: 'a b' } })).toBe('A search towards a number needs its name, without spaces')
  expect(documentOf({ ...draft, search: { ...search, stopAfter: '0' } })).toBe(
    'The failures after which it ends are a whole number, 1 at least',
  )
  expect(documentOf({ ...draft, factors: [] })).toBe('A search varies something: add a factor')
})

it('proposes a name that is free', () => {
  expect(proposedId('behaviors/a/transfer.yaml', [])).toBe('behaviors/sweeps/transfer.yaml')
  expect(proposedId('behaviors/a/transfer.yaml', ['behaviors/sweeps/transfer.yaml'])).toBe('behaviors/sweeps/transfer_2.yaml')
})

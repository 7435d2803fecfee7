/** What a sweep has shown, in words, orders and scales. Pure. */
import type {
  Factor,
  FactorChoice,
  FactorCoverage,
  Interval,
  JudgedRequirement,
  MeasureSpread,
  Quantiles,
  SearchSpec,
  SweepDocument,
  SweepLine,
  SweepLive,
  SweepRuns,
  SweepView,
  TrialResult,
} from '../api/types'
import { lookup } from './dict'
import { numeral, plainText } from './values'
import { fileTitle } from './path'

/** A share as a percentage; what is not quite everything never reads as 100 %. */
export function percent(share: number): string {
  const shown = (100 * share).toFixed(1)
  return shown === '100.0' && share < 1 ? '> 99.9 %' : `${shown} %`
}

export function intervalText([low, high]: Interval): string {
  return `${percent(low)} to ${percent(high)}`
}

/** The success rate of the runs that were looked at; undefined before the first one. */
export function rateOf(live: SweepLive): number | undefined {
  return live.looked_at > 0 ? live.successes / live.looked_at : undefined
}

/** The last part of the path of a document, without its suffix. */
export function sweepName(id: string): string {
  return fileTitle(id)
}

/** How far it is now: what the stream tells while it is executed, else what was read. */
export function currentLive(line: SweepLine, reported: SweepLive | undefined): SweepLive {
  if (reported && reported.status !== 'idle') return reported
  return { ...line.live, problem: reported?.problem ?? '' }
}

const VERDICTS = { passed: ['done', 'Passed'], failed: ['failed', 'Failed'], undecided: ['idle', 'Undecided'] } as const

/** The status and the word of what is required; undefined where nothing is. */
export function verdictWords(verdict: SweepLive['verdict']): readonly ['done' | 'failed' | 'idle', string] | undefined {
  return verdict === null ? undefined : VERDICTS[verdict]
}

/** The speed of a sweep and what it leaves: `41 runs/min, 9 min left`. */
export function speedText(live: SweepLive): string {
  const parts = live.rate_hz > 0 ? [`${numeral(Number((60 * live.rate_hz).toPrecision(3)))} runs/min`] : []
  if (live.remaining_s !== null && live.done < live.planned) parts.push(`${roughly(live.remaining_s)} left at most`)
  return parts.join(', ')
}

function roughly(seconds: number): string {
  if (seconds < 60) return `${Math.ceil(seconds)} s`
  return seconds < 3600 ? `${Math.round(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`
}

/** The success rate in `success >= 0.98`, or in a list of requirements; undefined where none is required. */
export function requiredRate(require: string | readonly string[] | null | undefined): number | undefined {
  const texts = typeof require === 'string' ? require.split(';') : (require ?? [])
  const rates = texts.flatMap((text) => /^\s*success\s*>=(.+)$/.exec(text)?.[1] ?? []).map(Number)
  return rates.length > 0 ? Math.max(...rates) : undefined
}

/** What is required in words: `at least 98.0 %`, or as it is written where it is more than a success rate. */
export function requiredText(require: string): string {
  const rate = require.includes(';') ? undefined : requiredRate(require)
  return rate === undefined ? require : `at least ${percent(rate)}`
}

/** How many of the runs that were looked at keep a requirement: `12 of 20 (3 without the number)`. */
export function keptText({ kept, runs, missing }: JudgedRequirement): string {
  return `${kept} of ${runs}${missing > 0 ? ` (${missing} without the number)` : ''}`
}

export interface QuantileGroup {
  readonly key: string
  readonly title: string
  readonly rows: readonly Quantiles[]
}

/** The distributions of a sweep that have any values. */
export function quantileGroups({ duration_s, nodes, outputs, measures }: SweepView): readonly QuantileGroup[] {
  const groups = [
    { key: 'duration', title: 'Duration of runs that succeeded, s', rows: duration_s === null ? [] : [duration_s] },
    { key: 'nodes', title: 'Time in each node, s', rows: nodes },
    { key: 'outputs', title: 'Outputs', rows: outputs },
    { key: 'measures', title: 'Measures of runs that succeeded, and of those that failed', rows: measures.flatMap(measureRows) },
  ]
  return groups.filter((group) => group.rows.length > 0)
}

function measureRows({ name, successes, failures }: MeasureSpread): readonly Quantiles[] {
  return [...(successes === null ? [] : [{ ...successes, name }]), ...(failures === null ? [] : [{ ...failures, name: `${name}, failed` }])]
}

/** How much of a factor the runs have covered, and where there was none. */
export function coverageText({ parts, covered, gap, gap_share }: FactorCoverage): string {
  const share = `${covered} of ${parts} parts have a run`
  return gap === null
    ? share
    : `${share}; none from ${short(gap[0])} to ${short(gap[1])}${gap_share === null ? '' : ` (${percent(gap_share)})`}`
}

export interface RunOrder {
  readonly by: string
  readonly isFalling: boolean
}

/** As the server lists them: failing runs first. */
export const FIRST_ORDER: RunOrder = { by: 'ended', isFalling: false }

/** Runs in an order; those that are equal in it stay as they are. */
export function orderedRuns(runs: readonly TrialResult[], { by, isFalling }: RunOrder): readonly TrialResult[] {
  const sign = isFalling ? -1 : 1
  return runs.toSorted((left, right) => sign * compared(cellOf(left, by), cellOf(right, by)))
}

/** What stands in a column: a number where it is one. */
export function cellOf(run: TrialResult, column: string): unknown {
  switch (column) {
    case 'number':
      return run.configuration.number
    case 'ended':
      return `${run.success ? 1 : 0} ${labelOf(run)}`
    case 'cause':
      return run.reason
    case 'duration':
      return run.duration_s
    default:
      return lookup(run.configuration.values, column)
  }
}

/** A number of a run by its name: a measure, userdata at its end, or its duration. */
export function numberOf(run: TrialResult, name: string): number | undefined {
  return name === 'duration_s' ? run.duration_s : (lookup(run.measures, name) ?? lookup(run.outputs, name))
}

function compared(left: unknown, right: unknown): number {
  if (typeof left === 'number' && typeof right === 'number') return left - right
  return plainText(left ?? '').localeCompare(plainText(right ?? ''), 'en', { numeric: true })
}

/** Its outcome, or its status where it has none. */
export function labelOf(run: TrialResult): string {
  return run.outcome ?? run.status
}

/** The runs with the same cause as one of them. */
export function alikeOf(runs: SweepRuns, example: number | undefined): ReadonlySet<number> {
  return new Set(runs.alike.find((group) => example !== undefined && group.includes(example)) ?? [])
}

/** What runs can be drawn over: factors that vary, numbers first, else in the order given; and the duration. */
export function scatterAxes(runs: readonly TrialResult[], addresses: readonly string[]): readonly string[] {
  const varied = addresses.filter((address) => new Set(runs.map((run) => String(lookup(run.configuration.values, address)))).size > 1)
  const isNumber = (address: string) => runs.every((run) => typeof lookup(run.configuration.values, address) === 'number')
  return [...varied.filter(isNumber), ...varied.filter((address) => !isNumber(address)), 'duration']
}

/** Places on one axis, from 0 to 1, and what its ends or values are called. */
export interface AxisScale {
  readonly of: (run: TrialResult) => number
  readonly marks: readonly { readonly at: number; readonly label: string }[]
}

export function axisScale(runs: readonly TrialResult[], axis: string): AxisScale {
  const values = runs.map((run) => cellOf(run, axis))
  if (values.every((value) => typeof value === 'number')) {
    const [least, most] = [Math.min(...values), Math.max(...values)]
    const span = most - least || 1
    const marks = [0, 0.5, 1].map((at) => ({ at, label: short(least + at * span) }))
    return { of: (run) => (Number(cellOf(run, axis)) - least) / span, marks }
  }
  const names = [...new Set(values.map(String))].toSorted((left, right) => left.localeCompare(right))
  const at = (name: string) => (names.indexOf(name) + 0.5) / names.length
  return { of: (run) => at(String(cellOf(run, axis))), marks: names.map((label) => ({ at: at(label), label })) }
}

/** A number with four digits. */
export function short(value: unknown): string {
  return typeof value === 'number' ? numeral(Number(value.toPrecision(4))) : String(value)
}

/** A factor as it is written in a form. */
export interface FactorDraft {
  readonly address: string
  readonly kind: 'uniform' | 'log_uniform' | 'normal' | 'values'
  /** The least value, or the mean. */
  readonly first: string
  /** The greatest value, or the standard deviation. */
  readonly second: string
  /** Values, with commas between them. */
  readonly values: string
}

/** What is proposed for a value of the behavior or the cell. */
export function proposedFactor(choice: FactorChoice): FactorDraft {
  const { address, nominal, least, most, options } = choice
  const draft: FactorDraft = { address, kind: 'uniform', first: '', second: '', values: '' }
  if (options.length > 0) return { ...draft, kind: 'values', values: options.map((each) => JSON.stringify(each)).join(', ') }
  if (address.startsWith('displace.')) return { ...draft, kind: 'normal', first: '0', second: address.endsWith('_rad') ? '0.1' : '0.005' }
  if (least !== null && most !== null) return { ...draft, first: String(least), second: String(most) }
  if (typeof nominal === 'number' && nominal !== 0) {
    const ends = [0.8 * nominal, 1.2 * nominal].toSorted((left, right) => left - right).map(short)
    return { ...draft, first: ends[0] ?? '', second: ends[1] ?? '' }
  }
  return typeof nominal === 'number' ? draft : { ...draft, kind: 'values', values: nominal === null ? '' : JSON.stringify(nominal) }
}

/** The factor of a document, or what is wrong with it. */
export function factorOf(draft: FactorDraft): Factor | string {
  const name = draft.address || 'a factor'
  if (!draft.address) return 'A factor needs a name'
  if (draft.kind === 'values') {
    const values = draft.values
      .split(',')
      .map((each) => each.trim())
      .filter(Boolean)
    return values.length > 0 ? { values: values.map(parsed) } : `${name} needs values`
  }
  const [first, second] = [Number(draft.first), Number(draft.second)]
  const isWhole = draft.first.trim() !== '' && draft.second.trim() !== '' && Number.isFinite(first) && Number.isFinite(second)
  if (!isWhole) return `${name} needs two numbers`
  if (draft.kind === 'normal') return second > 0 ? { normal: { mean: first, deviation: second } } : `the deviation of ${name} is above 0`
  if (first >= second) return `${name} goes from the least to the greatest value`
  return { [draft.kind]: [first, second] }
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text) as unknown
  } catch {
    return text
  }
}

/** What a search goes towards and when it ends, as it is written in a form. */
export interface SearchDraft {
  readonly towards: 'failure' | 'least' | 'most'
  /** The number whose least or largest value is searched for. */
  readonly name: string
  readonly method: 'cross_entropy' | 'optuna'
  /** Failures; empty for all runs. */
  readonly stopAfter: string
}

export interface SweepDraft {
  readonly id: string
  readonly behavior: string
  readonly runs: string
  /** In percent; empty for none. */
  readonly required: string
  readonly factors: readonly FactorDraft[]
  /** None for a random design, which tells a rate. */
  readonly search: SearchDraft | undefined
}

/** The document of a form, or what is wrong with it. */
export function documentOf(draft: SweepDraft): SweepDocument | string {
  const runs = Number(draft.runs)
  if (!draft.behavior) return 'Choose a behavior'
  if (!Number.isInteger(runs) || runs < 1) return 'Runs are a whole number, 1 at least'
  const required = Number(draft.required)
  const isRequired = draft.required.trim() !== ''
  if (isRequired && !(required >= 0 && required <= 100)) return 'The required success rate is 0 to 100 %'
  const factors = new Map<string, Factor>()
  for (const each of draft.factors) {
    const factor = factorOf(each)
    if (typeof factor === 'string') return factor
    if (factors.has(each.address)) return `${each.address} is there twice`
    factors.set(each.address, factor)
  }
  const common = { flexcell: 1 as const, behavior: draft.behavior, factors: Object.fromEntries(factors) }
  if (draft.search) {
    if ([...factors.keys()].every((address) => address === 'seed')) return 'A search varies something: add a factor'
    const search = searchOf(draft.search, runs)
    return typeof search === 'string' ? search : { ...common, search }
  }
  return { ...common, runs, ...(isRequired && { require: `success >= ${Number((required / 100).toPrecision(10))}` }) }
}

/** The search of a document, or what is wrong with it. */
function searchOf({ towards, name, method, stopAfter }: SearchDraft, runs: number): SearchSpec | string {
  const number = name.trim()
  if (towards !== 'failure' && !/^\S+$/.test(number)) return 'A search towards a number needs its name, without spaces'
  const failures = Number(stopAfter)
  const isEnding = stopAfter.trim() !== ''
  if (isEnding && (!Number.isInteger(failures) || failures < 1)) return 'The failures after which it ends are a whole number, 1 at least'
  return { towards: towards === 'failure' ? towards : `${towards} ${number}`, method, runs, ...(isEnding && { stop_after: failures }) }
}

/** A free name for the sweep of a behavior. */
export function proposedId(behavior: string, taken: readonly string[]): string {
  const stem = sweepName(behavior) || 'sweep'
  for (let count = 1; ; count++) {
    const id = `behaviors/sweeps/${stem}${count > 1 ? `_${count}` : ''}.yaml`
    if (!taken.includes(id)) return id
  }
}

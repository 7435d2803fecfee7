/** A failure in words: what was measured against what was expected, what differs from the last good run, and a report of all. Pure. */
import type { CauseLine, MeasuredValue, NodeDifference, RunComparison, RunFailure, RunView } from '../api/types'
import { runWords } from './runState'
import { duration, wallTime } from './time'
import { firstOfPath } from './path'

/** So many nodes are named whose time is another one. */
const SLOWEST = 5
const LEAST_DIFFERENCE_S = 0.1
const LEAST_SHARE = 0.2

/** `20 to 40 mm`, `at most 0.05 m`. */
export function expectedWords({ least, most, unit }: MeasuredValue): string {
  const [low, high] = [least ?? null, most ?? null]
  if (low !== null && high !== null) return `${number(low)} to ${number(high)} ${unit}`
  if (high !== null) return `at most ${number(high)} ${unit}`
  return low !== null ? `at least ${number(low)} ${unit}` : '–'
}

export function measuredWords({ measured, unit }: MeasuredValue): string {
  return `${number(measured)} ${unit}`
}

/** `18.8 mm too small`; empty where it is as expected. */
export function missWords({ measured, least, most, unit }: MeasuredValue): string {
  if (measured < (least ?? -Infinity)) return `${number((least ?? 0) - measured)} ${unit} too small`
  return measured > (most ?? Infinity) ? `${number(measured - (most ?? 0))} ${unit} too large` : ''
}

function number(value: number): string {
  return String(Number(value.toPrecision(4)))
}

/** What differs from the last good run, one line each; empty where nothing does. */
export function differenceLines(comparison: RunComparison): readonly string[] {
  const settings = comparison.settings.map(({ at, left, right }) => `${at}: ${left ?? 'not set'} before, ${right ?? 'not set'} now`)
  const documents = comparison.documents.map(({ name }) => `${name} has changed`)
  return [...settings, ...documents, ...slowest(comparison.nodes).map(durationWords)]
}

function slowest(nodes: readonly NodeDifference[]): readonly NodeDifference[] {
  // Containers take as long as what is inside them.
  const leaves = nodes.filter(
    (node) => node.visits_left > 0 && node.visits_right > 0 && !nodes.some((other) => other.path.startsWith(`${node.path}/`)),
  )
  return leaves
    .filter((node) => change(node) >= Math.max(LEAST_DIFFERENCE_S, LEAST_SHARE * node.duration_left_s))
    .toSorted((a, b) => change(b) - change(a))
    .slice(0, SLOWEST)
}

function change(node: NodeDifference): number {
  return Math.abs(node.duration_right_s - node.duration_left_s)
}

function durationWords({ path, duration_left_s: before, duration_right_s: now }: NodeDifference): string {
  return `${path}: ${duration(before)} before, ${duration(now)} now`
}

/** `left arm: line to a pose: joint 4 would exceed its limit`: who says it, where that is a skill of a device, and what. */
export function causeWords({ skill, message }: CauseLine): string {
  return skill ? `${skill}: ${message}` : message
}

const WORD = /[\p{L}\p{N}_./-]+/gu

/** Names that may be those of a part, frame or arm in the cell: first what the causes say, then the arms that were asked. */
export function placesOf(failure: RunFailure, arms: readonly string[]): readonly string[] {
  const words = failure.links.flatMap((link) => link.message.match(WORD) ?? [])
  const addresses = [...failure.links.map((link) => link.where), ...failure.around.flatMap((line) => line.text.match(WORD) ?? [])]
  const asked = addresses.map(firstOfPath).filter((name) => arms.includes(name))
  // `left` is a side in a sentence, and an arm in an address.
  return [...new Set([...words.filter((word) => !arms.includes(word)), ...asked])].slice(0, MAX_PLACES)
}

const MAX_PLACES = 50

/** Everything that a colleague needs, as text. */
export function reportOf(run: RunView, failure: RunFailure, comparison: RunComparison | undefined, address: string): string {
  const where = failure.path ? `${failure.path} at ${failure.time_s.toFixed(2)} s` : `the run itself at ${failure.time_s.toFixed(2)} s`
  const head = [
    `Behavior: ${run.behavior}`,
    `Run: ${run.id}, started ${wallTime(run.started_at_s)}, ${duration(run.duration_s)}`,
    `State: ${runWords(run)}`,
    `Where: ${where}`,
    `What failed: ${failure.text}`,
    ...(failure.hint ? [`What to do: ${failure.hint}`] : []),
    `Page: ${address}`,
  ]
  const why = failure.links.flatMap((link) => [
    `- ${causeWords(link)}${source(link.where, link.kind)}`,
    ...link.compared.map((each) => `  ${each.quantity}: measured ${measuredWords(each)}, expected ${expectedWords(each)}`),
  ])
  const around = failure.around.map((line) => `- ${line.time_s.toFixed(2)} s ${line.text}`)
  const good = comparison
    ? [comparison.divergence?.text ?? 'nothing diverges', ...differenceLines(comparison)].map((line) => `- ${line}`)
    : ['- no earlier run succeeded']
  return [
    ...head,
    ...section('Why, innermost cause first', why),
    ...section('What happened there', around),
    ...section(comparison ? `Against the last good run ${comparison.left.id}` : 'Against the last good run', good),
  ].join('\n')
}

function section(title: string, lines: readonly string[]): readonly string[] {
  return lines.length > 0 ? ['', `${title}:`, ...lines] : []
}

function source(where: string, kind: string): string {
  const words = [kind, where].filter(Boolean).join(', ')
  return words ? ` (${words})` : ''
}

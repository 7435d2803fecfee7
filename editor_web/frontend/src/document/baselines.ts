/** What a sweep is compared with, in words and scales. Pure. */
import type { Baseline, Interval, RatePair } from '../api/types'
import { percent } from './sweeps'

/** A version as one line: when it was executed, how it did, what differs from now, and where its results are. */
export function baselineName({ results, version }: Baseline): string {
  const { runs, successes, changed, saved_unix_s: saved } = version
  const when = new Date(1000 * saved).toLocaleString('en', { dateStyle: 'medium', timeStyle: 'short' })
  const parts = [when, `${successes} of ${runs} succeeded`]
  if (changed.length > 0) parts.push(`differs in ${changed.join(', ')}`)
  if (!results.startsWith('.flexcell/')) parts.push(results)
  return parts.join(' · ')
}

/** How much lower the rate may be, from 0 to 1, of what is written in points; undefined for nothing; or what is wrong. */
export function marginOf(text: string): number | undefined | string {
  if (text.trim() === '') return undefined
  const points = Number(text)
  return points >= 0 && points <= 100 ? Number((points / 100).toPrecision(10)) : 'The margin is 0 to 100 points'
}

/** The success rates of the baseline and of the version now, on the runs of both. */
export function ratesOf({
  both,
  only_first: broken,
  only_second: mended,
  neither,
}: RatePair): readonly { readonly name: string; readonly successes: number; readonly runs: number }[] {
  const runs = both + broken + mended + neither
  return [
    { name: 'Baseline', successes: both + broken, runs },
    { name: 'Now', successes: both + mended, runs },
  ]
}

/** A difference of rates in percentage points. */
export function pointsText(difference: number): string {
  return `${difference < 0 ? '−' : '+'}${Math.abs(100 * difference).toFixed(1)}`
}

export function pointsIntervalText([low, high]: Interval): string {
  return `${pointsText(low)} to ${pointsText(high)} points`
}

/** Where differences are on a line from 0 to 1 whose middle is no difference. */
export function differenceScale([low, high]: Interval, margin: number | null): (difference: number) => number {
  const most = Math.max(Math.abs(low), Math.abs(high), margin ?? 0, 0.01) * 1.05
  return (difference) => 0.5 + difference / (2 * most)
}

export function shareText(successes: number, runs: number): string {
  return runs > 0 ? percent(successes / runs) : '–'
}

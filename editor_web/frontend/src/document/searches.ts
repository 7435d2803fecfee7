/** What a search for failures and a shrunk run have shown, in words and rows. Pure. */
import type { Configuration, SearchLive, SearchView, Shrinking, Shrunk, ShrunkTrial, SweepLine, SweepView } from '../api/types'
import { lookup } from './dict'
import { sweepName, short } from './sweeps'

export function isSearch(view: SweepView | SearchView): view is SearchView {
  return 'clusters' in view
}

/** What a sweep or search consists of, in the words of the list. */
export function designText({ design, towards }: SweepLine): string {
  if (towards === 'failure') return 'search for failures'
  if (towards) return `search for failures towards ${towards}`
  return design && `${design.replace('_', ' ')} design`
}

export function failuresText({ failures }: SearchLive): string {
  if (failures === 0) return 'no failure'
  return failures === 1 ? '1 failure' : `${failures} failures`
}

/** The least and the largest number, or all values of a list. */
export function rangeText(values: readonly unknown[], isListed: boolean): string {
  return values.map(short).join(isListed ? ', ' : ' to ')
}

export interface ShrunkRow {
  readonly address: string
  readonly nominal: string
  readonly failing: string
  /** The nearest value with which it did not fail so; empty where none was tried. */
  readonly passing: string
}

/** What is left of the change from nominal, one factor a row. */
export function shrunkRows({ changed, passes }: Shrunk): readonly ShrunkRow[] {
  return Object.entries(changed).map(([address, pair]) => ({
    address,
    nominal: short(pair?.[0]),
    failing: short(pair?.[1]),
    passing: address in passes ? short(lookup(passes, address)) : '',
  }))
}

/** What chance has to do with it: the seed and the placement noise. */
export function chanceText({ result, changed, seed_matters: seedMatters, placement_noise: isNoisy }: Shrunk): string {
  const { seed } = result.configuration
  const noise = isNoisy ? 'with placement noise' : 'without placement noise'
  if (Object.keys(changed).length > 0)
    return seedMatters ? `Seed ${seed}: with the nominal one it does not fail so; ${noise}.` : `Seed ${seed}, ${noise}.`
  return seedMatters
    ? `Nothing is varied: seed ${seed} alone fails, ${noise}.`
    : `Nothing is varied: it fails with all nominal values, ${noise}.`
}

/** What was found, if it is of this run: a number is another run once the sweep or the behavior has changed. */
export function foundOf(shrinking: Shrinking | undefined, subject: string, run: Configuration): ShrunkTrial | undefined {
  const found = shrinking?.found
  return found?.subject === subject && JSON.stringify(found.failing) === JSON.stringify(run) ? found : undefined
}

/** The file that is proposed for a test case. */
export function proposedCase(sweep: string, number: number): string {
  return `tests/cases/${sweepName(sweep)}_${number}.yaml`
}

/** The watches of each behavior: expressions whose values are shown beside the data of its runs. Kept in this browser. */
import { addWatch, isSameWatch, readWatches, type WatchesByBehavior } from '../document/watches'
import { lookup } from '../document/dict'
import { pageStore } from './pageStore'
import type { Watch } from './types'

const KEPT = 'flexcell.watches'
const NONE: readonly Watch[] = []

export const useWatchStore = pageStore<{ readonly byBehavior: WatchesByBehavior }>(() => ({ byBehavior: kept() }))

export function useWatches(behavior: string): readonly Watch[] {
  return useWatchStore((s) => lookup(s.byBehavior, behavior)) ?? NONE
}

export function watchValueOf(behavior: string, watch: Watch): void {
  keep(behavior, (all) => addWatch(all, watch))
}

/** Put another one in its place; without one it is taken away. */
export function replaceWatch(behavior: string, old: Watch, fresh?: Watch): void {
  keep(behavior, (all) => all.flatMap((each) => (isSameWatch(each, old) ? (fresh ?? []) : each)))
}

function keep(behavior: string, edit: (all: readonly Watch[]) => readonly Watch[]): void {
  const { byBehavior } = useWatchStore.getState()
  const next = { ...byBehavior, [behavior]: edit(lookup(byBehavior, behavior) ?? NONE) }
  useWatchStore.setState({ byBehavior: next })
  localStorage.setItem(KEPT, JSON.stringify(next))
}

function kept(): WatchesByBehavior {
  try {
    return readWatches(JSON.parse(localStorage.getItem(KEPT) ?? 'null'))
  } catch {
    // What somebody else has written there is no reason not to start.
    return {}
  }
}

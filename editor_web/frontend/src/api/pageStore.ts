/** What a page remembers: every store of it is made here, so that all of them begin anew together, and share nothing. */
import { create, type StoreApi, type UseBoundStore } from 'zustand'

const all: (() => void)[] = []

/** A store of the page. `blank` makes what it begins with; `end` closes what it holds, where it holds what must be closed. */
export function pageStore<T>(blank: () => T, end?: (state: T) => void): UseBoundStore<StoreApi<T>> {
  const store = create<T>(blank)
  beginsAnew(store, blank, end)
  return store
}

/** The same for a store that was made elsewhere. */
export function beginsAnew<T>(store: StoreApi<T>, blank: () => T, end?: (state: T) => void): void {
  all.push(() => {
    end?.(store.getState())
    store.setState(blank(), true)
  })
}

/** Begin anew, as when the page has just been loaded. */
export function beginPage(): void {
  for (const begin of all) begin()
}

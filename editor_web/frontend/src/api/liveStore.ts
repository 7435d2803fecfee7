/** What is live, as a store: one of the whole page, and where several runs are shown together one of each. */
import { createContext, useContext } from 'react'
import { createStore, useStore, type StoreApi } from 'zustand'
import { EMPTY, type LiveState } from '../document/live'
import type { ShownMoment } from '../document/timelineMoment'
import { beginsAnew } from './pageStore'

export type Connection = 'connecting' | 'live' | 'lost' | 'denied'

export interface LiveStore extends LiveState {
  readonly connection: Connection
  /** Counts restarts of the server; what was fetched before one is out of date. */
  readonly generation: number
  /** The run that this page operates; kept over a reload of the page, empty for none. */
  readonly operated: string
  /** The moment of the past whose nodes, log and clock are shown in the place of the live ones. */
  readonly past: ShownMoment | undefined
  /** Whether the server has told what runs it has. */
  readonly knowsRuns: boolean
}

export function newLiveStore(operated = ''): StoreApi<LiveStore> {
  return createStore<LiveStore>(() => ({
    ...EMPTY,
    connection: 'connecting',
    generation: 0,
    operated,
    past: undefined,
    knowsRuns: false,
  }))
}

export const OPERATED = 'flexcell.operated'

const operatedBefore = () => sessionStorage.getItem(OPERATED) ?? ''
const page = newLiveStore(operatedBefore())
beginsAnew(page, () => newLiveStore(operatedBefore()).getState())

/** The store that what stands inside shows; without one it is that of the page. */
export const LiveContext = createContext<StoreApi<LiveStore>>(page)

function useLiveHere<T>(select: (state: LiveStore) => T): T {
  return useStore(useContext(LiveContext), select)
}

/** As a hook it tells of the run that is shown here; its `getState` is always that of the page. */
export const useLive: typeof useLiveHere & StoreApi<LiveStore> = Object.assign(useLiveHere, page)

/** The store of the run that is shown here. */
export function useLiveStore(): StoreApi<LiveStore> {
  return useContext(LiveContext)
}

/** Is this a part of the page that shows one run only? */
export function useIsPage(): boolean {
  return useContext(LiveContext) === page
}

/** The run that this page operates, wherever it is asked; empty for none. */
export function useOperated(): string {
  return useStore(page, (state) => state.operated)
}

/** Parts of what is live, for the many that each show one: who shows a node hears of that node only. */
import { lookup } from '../document/dict'
import { useCallback, useSyncExternalStore } from 'react'
import type { StoreApi } from 'zustand'
import { useLiveStore, type LiveStore } from './liveStore'
import type { ControlView, NodeLive } from './types'

type Listener = () => void

/** Who listens to one store. */
class Listeners {
  private readonly ofNodes = new Map<string, Set<Listener>>()
  private readonly ofHolds = new Set<Listener>()

  constructor(store: StoreApi<LiveStore>) {
    store.subscribe((now, before) => {
      if (now.nodes !== before.nodes) {
        for (const [path, listeners] of this.ofNodes) {
          if (lookup(now.nodes, path) !== lookup(before.nodes, path)) for (const listener of listeners) listener()
        }
      }
      if (now.control !== before.control || now.past !== before.past) for (const listener of this.ofHolds) listener()
    })
  }

  hearOfNode(path: string, listener: Listener): () => void {
    const listeners = this.ofNodes.get(path) ?? new Set()
    this.ofNodes.set(path, listeners.add(listener))
    return () => {
      listeners.delete(listener)
      if (listeners.size === 0) this.ofNodes.delete(path)
    }
  }

  hearOfHolds(listener: Listener): () => void {
    this.ofHolds.add(listener)
    return () => void this.ofHolds.delete(listener)
  }
}

const all = new WeakMap<StoreApi<LiveStore>, Listeners>()

function listenersOf(store: StoreApi<LiveStore>): Listeners {
  const known = all.get(store)
  if (known) return known
  const made = new Listeners(store)
  all.set(store, made)
  return made
}

/** What `select` takes from the state of one node; it must give the same value while nothing changes. */
export function useNodePart<T>(path: string, select: (live: NodeLive | undefined) => T): T {
  const store = useLiveStore()
  const subscribe = useCallback((listener: Listener) => listenersOf(store).hearOfNode(path, listener), [store, path])
  return useSyncExternalStore(subscribe, () => select(lookup(store.getState().nodes, path)))
}

/** The state of one node. */
export function useNodeLive(path: string): NodeLive | undefined {
  return useNodePart(path, (live) => live)
}

/** What `select` takes from what can be done with the run; it must give the same value while nothing changes. */
export function useControl<T>(select: (control: ControlView | null) => T): T {
  const store = useLiveStore()
  const subscribe = useCallback((listener: Listener) => listenersOf(store).hearOfHolds(listener), [store])
  return useSyncExternalStore(subscribe, () => select(store.getState().control))
}

/** The same of what holds the run now: nothing does while a moment of the past is shown. */
export function useHolds<T>(select: (control: ControlView | null) => T): T {
  const store = useLiveStore()
  const subscribe = useCallback((listener: Listener) => listenersOf(store).hearOfHolds(listener), [store])
  return useSyncExternalStore(subscribe, () => {
    const { control, past } = store.getState()
    return select(past === undefined ? control : null)
  })
}

/** Parts of what is live, for the many that each show one: who shows a node hears of that node only. */
import { useCallback, useSyncExternalStore } from 'react'
import { useLive } from './live'
import type { ControlLive, NodeLive } from './types'

type Listener = () => void

const ofNodes = new Map<string, Set<Listener>>()
const ofHolds = new Set<Listener>()

useLive.subscribe((now, before) => {
  if (now.nodes !== before.nodes) {
    for (const [path, listeners] of ofNodes) {
      if (now.nodes[path] !== before.nodes[path]) for (const listener of listeners) listener()
    }
  }
  if (now.control !== before.control || now.past !== before.past) for (const listener of ofHolds) listener()
})

function hearOfNode(path: string, listener: Listener): () => void {
  const listeners = ofNodes.get(path) ?? new Set()
  ofNodes.set(path, listeners.add(listener))
  return () => {
    listeners.delete(listener)
    if (listeners.size === 0) ofNodes.delete(path)
  }
}

function hearOfHolds(listener: Listener): () => void {
  ofHolds.add(listener)
  return () => void ofHolds.delete(listener)
}

/** What `select` takes from the state of one node; it must give the same value while nothing changes. */
export function useNodePart<T>(path: string, select: (live: NodeLive | undefined) => T): T {
  const subscribe = useCallback((listener: Listener) => hearOfNode(path, listener), [path])
  return useSyncExternalStore(subscribe, () => select(useLive.getState().nodes[path]))
}

/** The state of one node. */
export function useNodeLive(path: string): NodeLive | undefined {
  return useNodePart(path, (live) => live)
}

/** What `select` takes from what can be done with the run; it must give the same value while nothing changes. */
export function useControl<T>(select: (control: ControlLive | null) => T): T {
  return useSyncExternalStore(hearOfHolds, () => select(useLive.getState().control))
}

/** The same of what holds the run now: nothing does while a moment of the past is shown. */
export function useHolds<T>(select: (control: ControlLive | null) => T): T {
  return useSyncExternalStore(hearOfHolds, () => {
    const { control, past } = useLive.getState()
    return select(past === undefined ? control : null)
  })
}

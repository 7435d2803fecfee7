/** The live stream of one run, for pages that show several of them. */
import type { StoreApi } from 'zustand'
import { fold } from '../document/live'
import { keepConnected } from './connection'
import type { LiveStore } from './liveStore'

/** Follow a run into a store of its own; returns how to end it. */
export function followRun(run: string, store: StoreApi<LiveStore>): () => void {
  const watch = () => connection.send({ k: 'watch', run })
  const connection = keepConnected({
    onOpen: watch,
    onFrame: (frame) => {
      const before = store.getState()
      const next = fold(before, frame, performance.now())
      if (next === 'gap') {
        watch()
        return
      }
      const restarted = before.epoch !== '' && before.epoch !== next.epoch
      const knowsRuns = frame.k === 'snapshot' || (before.knowsRuns && !restarted)
      store.setState({ ...next, connection: 'live', generation: before.generation + (restarted ? 1 : 0), knowsRuns })
    },
    onLost: () => store.setState({ connection: 'lost', ticking: false }),
    onDenied: () => store.setState({ connection: 'denied' }),
  })
  return () => connection.close()
}

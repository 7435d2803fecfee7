/** The clock of an active run of this server, as it was last received: it goes on from there while the run does. */
import { useMemo } from 'react'
import { useLive } from '../api/live'
import { lookup } from '../document/dict'

export interface RunClock {
  /** Seconds on the run's clock at `atMs` of the page's own steady clock. */
  readonly fromS: number
  readonly atMs: number
  /** False while the run is paused or asks, and while nothing is heard of it. */
  readonly isTicking: boolean
}

/** Undefined for a run that is not one of this server's. */
export function useRunClock(id: string | undefined): RunClock | undefined {
  const latest = useLive((s) => (id === undefined ? undefined : s.runs.find((each) => each.id === id)))
  const atMs = useLive((s) => (id === undefined ? undefined : lookup(s.runsAtMs, id))) ?? 0
  const isConnected = useLive((s) => s.connection === 'live')
  return useMemo(() => latest && { fromS: latest.duration_s, atMs, isTicking: latest.ticking && isConnected }, [latest, atMs, isConnected])
}

/** Seconds on the run's clock at a moment of the page's. */
export function runClockS({ fromS, atMs, isTicking }: RunClock, nowMs: number): number {
  return isTicking ? fromS + Math.max(0, nowMs - atMs) / 1000 : fromS
}

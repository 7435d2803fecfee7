/** How long a run takes or took, on its clock: the same wherever a run is shown. */
import { useEffect, useState } from 'react'
import { useLive } from '../api/live'
import type { RunView } from '../api/types'
import { lookup } from '../document/dict'
import { isActive } from '../document/runState'
import { duration } from '../document/time'
import { Elapsed, TimeText } from './Elapsed'

/** A run that is active on this server goes on, also where it was read from the journal. */
export function RunTime({ run }: { readonly run: Pick<RunView, 'id' | 'status' | 'duration_s'> }) {
  const latest = useLive((s) => s.runs.find((each) => each.id === run.id))
  const receivedAtMs = useLive((s) => lookup(s.runsAtMs, run.id)) ?? 0
  const isWatched = useLive((s) => s.run === run.id && !s.past)
  const isConnected = useLive((s) => s.connection === 'live')
  if (!latest || !isActive(run)) return <TimeText>{duration(run.duration_s)}</TimeText>
  if (isActive(latest) && isWatched) return <Elapsed sinceS={0} />
  if (latest.ticking && isConnected) return <Ticking fromS={latest.duration_s} atMs={receivedAtMs} />
  return <TimeText>{duration(latest.duration_s)}</TimeText>
}

/** For runs that are not watched: they come again only where something changes. */
function Ticking({ fromS, atMs }: { readonly fromS: number; readonly atMs: number }) {
  const [nowMs, setNow] = useState(() => performance.now())
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 1000)
    return () => clearInterval(timer)
  }, [])
  return <TimeText>{duration(fromS + Math.max(0, nowMs - atMs) / 1000)}</TimeText>
}

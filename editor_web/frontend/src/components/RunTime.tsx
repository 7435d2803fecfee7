/** How long a run takes or took, on its clock: the same wherever a run is shown. */
import { useEffect, useState } from 'react'
import { useLive } from '../api/live'
import type { RunView } from '../api/types'
import { isActive } from '../document/runState'
import { duration } from '../document/time'
import { Elapsed, TimeText } from './Elapsed'
import { runClockS, useRunClock, type RunClock } from './runClock'

/** A run that is active on this server goes on, also where it was read from the journal. */
export function RunTime({ run }: { readonly run: Pick<RunView, 'id' | 'status' | 'duration_s'> }) {
  const isLatestActive = useLive((s) => isActive(s.runs.find((each) => each.id === run.id)))
  const isWatched = useLive((s) => s.run === run.id && !s.past)
  const clock = useRunClock(run.id)
  if (!clock || !isActive(run)) return <TimeText>{duration(run.duration_s)}</TimeText>
  if (isLatestActive && isWatched) return <Elapsed sinceS={0} />
  if (clock.isTicking) return <Ticking clock={clock} />
  return <TimeText>{duration(clock.fromS)}</TimeText>
}

/** For runs that are not watched: they come again only where something changes. */
function Ticking({ clock }: { readonly clock: RunClock }) {
  const [nowMs, setNow] = useState(() => performance.now())
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 1000)
    return () => clearInterval(timer)
  }, [])
  return <TimeText>{duration(runClockS(clock, nowMs))}</TimeText>
}

/** How long the run has taken so far; while it goes on and is seen, it goes on ten times a second. */
import { useEffect, useState } from 'react'
import { runClockS, useRunClock } from '../../components/runClock'
import type { LoadedTimeline } from '../../document/timeline'

const PERIOD_MS = 100

/** Seconds on the run's own clock, which stands while the run is paused; of a run that is over, or whose clock is not known, its length. */
export function useRunTime(course: LoadedTimeline | undefined, isWatched: boolean): number {
  const durationS = course?.durationS ?? 0
  const clock = useRunClock(course?.run)
  const goesOn = isWatched && course !== undefined && !course.ended && clock !== undefined
  const isTicking = goesOn && clock.isTicking
  const [atMs, setAt] = useState(() => performance.now())
  useEffect(() => {
    if (!isTicking) return
    const timer = setInterval(() => setAt(performance.now()), PERIOD_MS)
    return () => clearInterval(timer)
  }, [isTicking])
  // What has just been received is newer than the last tick.
  return goesOn ? Math.max(runClockS(clock, atMs), durationS) : durationS
}

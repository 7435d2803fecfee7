/** How long the run has taken so far; while it goes on and is seen, it goes on ten times a second. */
import { useEffect, useState } from 'react'
import type { LoadedTimeline } from '../../document/timeline'

export function useRunTime(course: LoadedTimeline | undefined, isTicking: boolean): number {
  const durationS = course?.durationS ?? 0
  const goesOn = isTicking && course !== undefined && !course.ended
  const [nowS, setNow] = useState(durationS)
  useEffect(() => {
    if (!goesOn) return
    const [sinceS, atMs] = [durationS, performance.now()]
    const timer = setInterval(() => setNow(sinceS + (performance.now() - atMs) / 1000), 100)
    return () => clearInterval(timer)
  }, [goesOn, durationS])
  return goesOn ? Math.max(nowS, durationS) : durationS
}

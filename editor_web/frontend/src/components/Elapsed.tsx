/** Time on the run's clock since `sinceS`, ticking ten times a second while the run does. */
import { useEffect, useState } from 'react'
import { useLive } from '../api/live'
import { duration } from '../document/time'

export function runClock(): number {
  const { nowS, ticking, atMs } = useLive.getState()
  return ticking ? nowS + (performance.now() - atMs) / 1000 : nowS
}

export function Elapsed({ sinceS }: { sinceS: number }) {
  const [now, setNow] = useState(runClock)
  useEffect(() => {
    const timer = setInterval(() => setNow(runClock()), 100)
    return () => clearInterval(timer)
  }, [])
  return <span className="elapsed">{duration(Math.max(0, now - sinceS))}</span>
}

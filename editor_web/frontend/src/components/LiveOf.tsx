/** Everything inside shows this run, whatever run the page shows. */
import { useEffect, useState, type ReactNode } from 'react'
import { LiveContext, newLiveStore } from '../api/liveStore'
import { followRun } from '../api/runStream'

/** Give it the run's id as its key as well: another run is another store. */
export function LiveOf({ run, children }: { run: string; children: ReactNode }) {
  const [store] = useState(() => newLiveStore())
  useEffect(() => followRun(run, store), [run, store])
  return <LiveContext value={store}>{children}</LiveContext>
}

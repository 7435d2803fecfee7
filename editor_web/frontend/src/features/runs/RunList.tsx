/** The runs of this server, newest first. */
import { useEffect, useState } from 'react'
import { serverNow, useLive } from '../../api/live'
import type { RunView } from '../../api/types'
import { Elapsed } from '../../components/Elapsed'
import { Empty } from '../../components/Empty'
import { PageLink } from '../../components/PageLink'
import { StatusIcon } from '../../components/StatusIcon'
import { isActive, runStateOf, runWords } from '../../document/runState'
import { duration, wallTime } from '../../document/time'
import { fileTitle } from '../../document/path'

export interface RunListProps {
  readonly current: string | undefined
  readonly href: (run: string) => string
  readonly onOpen: (run: string) => void
  readonly limit: number
}

export function RunList({ current, href, onOpen, limit }: RunListProps) {
  const runs = useLive((s) => s.runs)
  return (
    <nav className="run-list" aria-label="Runs">
      <h2 className="side-title">Runs</h2>
      {runs.length === 0 && <Empty title="No runs yet">Choose a behavior and start it.</Empty>}
      <ul className="plain-list">
        {runs.slice(0, limit).map((run) => (
          <li key={run.id}>
            <PageLink
              href={href(run.id)}
              className={`side-item run-item${run.id === current ? ' is-current' : ''}`}
              isCurrent={run.id === current}
              onOpen={() => onOpen(run.id)}
            >
              <StatusIcon status={runStateOf(run).look} size={15} />
              <span className="side-item-name">{nameOf(run.behavior)}</span>
              <span className="side-item-text">
                {wallTime(run.started_at_s)} · {runText(run)}
              </span>
            </PageLink>
          </li>
        ))}
      </ul>
    </nav>
  )
}

function runText(run: RunView): string {
  return isActive(run) ? runWords(run) : `${runWords(run)}, ${duration(run.duration_s)}`
}

/** The file name without its ending. */
export function nameOf(behavior: string): string {
  return fileTitle(behavior)
}

/** How long a run takes or took. */
export function RunTime({ run }: { run: RunView }) {
  const watched = useLive((s) => s.run)
  // The time of a paused run stands.
  if (isActive(run) && run.id === watched) return <Elapsed sinceS={0} />
  if (isActive(run) && run.waits !== 'paused') return <SinceStart startedS={run.started_at_s} />
  return <span className="elapsed">{duration(run.duration_s)}</span>
}

/** By the clock on the wall, for runs that are not watched. */
function SinceStart({ startedS }: { startedS: number }) {
  const [now, setNow] = useState(serverNow)
  useEffect(() => {
    const timer = setInterval(() => setNow(serverNow()), 1000)
    return () => clearInterval(timer)
  }, [])
  return <span className="elapsed">{duration(Math.max(0, now - startedS))}</span>
}

/** The runs that ended last, one line each. */
import { Checkbox } from '@mantine/core'
import type { RunView } from '../../api/types'
import { RunBadge } from '../../components/StatusBadge'
import { PageLink } from '../../components/PageLink'
import { isFailed } from '../../document/runState'
import { duration, wallTime } from '../../document/time'
import { nameOf } from './RunList'

interface FinishedRunsProps {
  readonly runs: readonly RunView[]
  readonly href: (run: string) => string
  readonly onOpen: (run: string) => void
  readonly chosen: readonly string[]
  readonly onChoose: (run: string, isChosen: boolean) => void
}

export function FinishedRuns({ runs, href, onOpen, chosen, onChoose }: FinishedRunsProps) {
  return (
    <ul className="plain-list finished-runs" aria-label="Runs that ended last">
      {runs.map((run) => (
        <li key={run.id}>
          <RunBadge run={run} />
          <PageLink href={href(run.id)} onOpen={() => onOpen(run.id)}>
            {nameOf(run.behavior)}
          </PageLink>
          <span className="quiet">
            {wallTime(run.started_at_s)}, {duration(run.duration_s)}
          </span>
          {run.cause && (
            <span className={`finished-cause${isFailed(run) ? '' : ' quiet'}`} title={run.cause}>
              {run.cause}
            </span>
          )}
          <span className="spacer" />
          <Checkbox
            size="xs"
            label="Compare"
            aria-label={`Compare ${nameOf(run.behavior)} of ${wallTime(run.started_at_s)}`}
            checked={chosen.includes(run.id)}
            onChange={(event) => onChoose(run.id, event.currentTarget.checked)}
          />
        </li>
      ))}
    </ul>
  )
}

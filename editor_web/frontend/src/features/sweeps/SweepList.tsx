/** The sweeps of the project with what they have shown, and results that no document asks for. */
import { IconChartDots } from '@tabler/icons-react'
import type { SweepLine, SweepList as Listed, UndescribedResults } from '../../api/types'
import { useLive } from '../../api/live'
import { Empty } from '../../components/Empty'
import { PageLink } from '../../components/PageLink'
import { StatusIcon } from '../../components/StatusIcon'
import { lookup } from '../../document/dict'
import { designText, failuresText } from '../../document/searches'
import { currentLive, intervalText, percent, rateOf, speedText, sweepName } from '../../document/sweeps'
import { VerdictBadge } from './VerdictBadge'

export interface SweepListProps {
  readonly listed: Listed
  readonly href: (id: string) => string
  readonly onOpen: (id: string) => void
}

export function SweepList({ listed, href, onOpen }: SweepListProps) {
  if (listed.sweeps.length === 0) {
    return (
      <Empty icon={<IconChartDots size={26} stroke={1.4} aria-hidden />} title="No sweeps yet">
        A sweep executes a behavior many times with varied parameters, parts and faults. Make one with the button above, or put a sweep
        document into the project.
      </Empty>
    )
  }
  return (
    <ul className="plain-list sweep-list" aria-label="Sweeps">
      {listed.sweeps.map((line) => (
        <Line key={line.id} line={line} href={href(line.id)} onOpen={() => onOpen(line.id)} />
      ))}
    </ul>
  )
}

function Line({ line, href, onOpen }: { readonly line: SweepLine; readonly href: string; readonly onOpen: () => void }) {
  const reported = useLive((s) => lookup(s.sweeps, line.id))
  const live = currentLive(line, reported)
  const rate = rateOf(live)
  return (
    <li className="sweep-line">
      <div className="sweep-line-head">
        <PageLink href={href} className="sweep-line-name" onOpen={onOpen}>
          {sweepName(line.id)}
        </PageLink>
        {live.status !== 'idle' && (
          <span className="badge is-active">
            <StatusIcon status="active" size={13} />
            {live.status}
          </span>
        )}
        <VerdictBadge live={live} require={line.require} />
      </div>
      <p className="quiet sweep-note">{[line.description, line.behavior, designText(line)].filter(Boolean).join(' · ')}</p>
      {line.problem ? (
        <p className="is-failed sweep-note">{line.problem}</p>
      ) : (
        <p className="sweep-note sweep-line-facts">
          <span>
            {live.done} of {live.planned} runs
          </span>
          {live.search && live.done > 0 && <span>{failuresText(live.search)}</span>}
          {rate !== undefined && (
            <span>
              {percent(rate)} succeeded{live.interval && <span className="quiet"> ({intervalText(live.interval)})</span>}
            </span>
          )}
          {live.status === 'running' && <span className="quiet">{speedText(live)}</span>}
        </p>
      )}
      {!line.problem && (
        <progress
          className="sweep-line-bar"
          max={Math.max(live.planned, 1)}
          value={live.done}
          aria-label={`${live.done} of ${live.planned} runs of ${sweepName(line.id)}`}
        />
      )}
    </li>
  )
}

export function OtherResults({ others }: { readonly others: readonly UndescribedResults[] }) {
  return (
    <>
      <p className="quiet sweep-note">
        Of the command line, or of versions before a change. They stay until the file of results is deleted.
      </p>
      <ul className="plain-list sweep-list" aria-label="Results of no sweep here">
        {others.map((each) => (
          <li key={each.subject} className="sweep-line">
            <p className="sweep-note">
              {each.behavior || 'A version that is not here any more'} <span className="mono quiet">{each.subject.slice(0, 12)}</span>
            </p>
            <p className="quiet sweep-note">
              {each.runs} {each.runs === 1 ? 'run' : 'runs'}, {each.successes} succeeded
            </p>
          </li>
        ))}
      </ul>
    </>
  )
}

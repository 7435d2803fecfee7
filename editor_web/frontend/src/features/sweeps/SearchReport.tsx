/** What a search for failures has found, as cards: how near, how likely, where, and its runs. It has no success rate. */
import { useMemo } from 'react'
import type { BatchTrace, SearchView, SweepRuns } from '../../api/types'
import { percent, short } from '../../document/sweeps'
import { FailureClusters } from './FailureClusters'
import { IntervalBar } from './IntervalBar'
import { NearestRuns } from './NearestRuns'
import { RunsCard, type RunsOf } from './RunsCard'
import { RunScatter } from './RunScatter'
import { SearchFigure } from './SearchFigure'
import { SweepCard } from './SweepCard'
import { useRunsOfCause } from './useRunsOfCause'

export interface SearchReportProps extends Omit<RunsOf, 'sweep' | 'subject'> {
  readonly view: SearchView
  readonly runs: SweepRuns
}

export function SearchReport({ view, runs, ...of }: SearchReportProps) {
  const { cause, shown, factors, choose } = useRunsOfCause(runs)
  // Drawn over those that tell most of the most frequent cause.
  const ordered = useMemo(
    () => [...new Set([...(view.clusters[0]?.regions ?? []).map((region) => region.address), ...factors])],
    [view, factors],
  )
  if (view.done === 0) return null
  return (
    <div className="sweep-cards">
      <div className="sweep-column">
        <SweepCard title="How near to failure">
          <SearchFigure figure={view.figure} selected={of.selected} onSelect={of.onSelect} />
          <p className="quiet sweep-note">{view.method}</p>
        </SweepCard>
        <SweepCard title="Runs over two factors">
          <RunScatter runs={shown} factors={ordered} selected={of.selected} onSelect={of.onSelect} />
        </SweepCard>
        {view.nearest.length > 0 && (
          <SweepCard title={view.target.guides ? 'Nearest successes' : 'Successes that took longest'}>
            <NearestRuns view={view} onSelect={of.onSelect} />
          </SweepCard>
        )}
      </div>
      <div className="sweep-column">
        <SweepCard title="How likely a failure is">
          {view.probability && (
            <p className="sweep-likelihood">
              <strong>{percent(view.probability.estimate)}</strong>
              <IntervalBar interval={view.probability.interval} rate={view.probability.estimate} isBad />
            </p>
          )}
          <p className="sweep-note">{view.likelihood}</p>
        </SweepCard>
        {view.clusters.length > 0 && (
          <SweepCard title="Where it fails">
            <FailureClusters clusters={view.clusters} chosen={cause} onChoose={choose} />
          </SweepCard>
        )}
        <SweepCard title="Batches">
          <Batches view={view} />
        </SweepCard>
      </div>
      <RunsCard
        {...of}
        sweep={view.line.id}
        subject={view.subject}
        runs={runs}
        shown={shown}
        factors={factors}
        cause={cause}
        onShowAll={() => choose(undefined)}
      />
    </div>
  )
}

function Batches({ view }: { readonly view: SearchView }) {
  return (
    <div className="sweep-scroll" tabIndex={0} role="group" aria-label="Table of batches">
      <table className="sweep-table">
        <thead>
          <tr>
            {['Batch', 'Runs', 'Failures', 'Refused', view.towards].map((name) => (
              <th key={name} scope="col" className="is-number">
                {name}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {view.batches.map((each) => (
            <Batch key={each.batch} batch={each} />
          ))}
        </tbody>
      </table>
    </div>
  )
}

function Batch({ batch }: { readonly batch: BatchTrace }) {
  return (
    <tr>
      <th scope="row" className="is-number">
        {batch.batch}
      </th>
      {[batch.runs, batch.failures, batch.refused].map((count, at) => (
        <td key={at} className="is-number">
          {count}
        </td>
      ))}
      <td className="is-number">{batch.nearest === null ? '–' : short(batch.nearest)}</td>
    </tr>
  )
}

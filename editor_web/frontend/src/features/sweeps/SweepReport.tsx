/** Everything that a sweep has shown, as cards; a chosen cause or point leads to runs, a chosen run to itself. */
import { useMemo, useState, type ReactNode } from 'react'
import type { SweepRuns, SweepView } from '../../api/types'
import { ViewBoundary } from '../../components/ViewBoundary'
import { alikeOf, requiredRate } from '../../document/sweeps'
import { CoveredInputs } from './CoveredInputs'
import { Distributions } from './Distributions'
import { FactorEffects } from './FactorEffects'
import { MissedItems } from './MissedItems'
import { CauseList, OutcomeTable } from './Outcomes'
import { RateCurve } from './RateCurve'
import { Requirements } from './Requirements'
import { RunDetails } from './RunDetails'
import { RunScatter } from './RunScatter'
import { RunTable } from './RunTable'

export interface SweepReportProps {
  readonly view: SweepView
  readonly runs: SweepRuns
  readonly mayOperate: boolean
  readonly selected: number | undefined
  readonly onSelect: (run: number | undefined) => void
  readonly onOpenRecording: (path: string) => void
}

export function SweepReport({ view, runs, mayOperate, selected, onSelect, onOpenRecording }: SweepReportProps) {
  const [cause, setCause] = useState<number>()
  const alike = useMemo(() => alikeOf(runs, cause), [runs, cause])
  const shown = useMemo(() => (alike.size > 0 ? runs.runs.filter((run) => alike.has(run.configuration.number)) : runs.runs), [runs, alike])
  const factors = useMemo(() => Object.keys(runs.runs[0]?.configuration.values ?? {}).filter((address) => address !== 'seed'), [runs])
  // Drawn over those that matter most; `seed` is none that one looks at first.
  const ordered = useMemo(() => [...new Set([...view.effects.map((effect) => effect.address).filter((address) => address !== 'seed'), ...factors])], [view, factors])
  if (view.done === 0) return null
  return (
    <div className="sweep-cards">
      <div className="sweep-column">
        <Card title="Success rate after each run">
          <RateCurve curve={view.curve} required={requiredRate(view.document.require)} />
          <Requirements requirements={view.requirements} />
        </Card>
        {factors.length > 0 && (
          <Card title="Runs over two factors">
            <RunScatter runs={shown} factors={ordered} selected={selected} onSelect={onSelect} />
          </Card>
        )}
        <Card title="Distributions">
          <Distributions view={view} />
        </Card>
      </div>
      <div className="sweep-column">
        <Card title="How runs ended">
          {view.causes.length > 0 && (
            <>
              <h3 className="sweep-subtitle">Causes of failures</h3>
              <CauseList causes={view.causes} chosen={cause} onChoose={setCause} />
            </>
          )}
          <h3 className="sweep-subtitle">Outcomes</h3>
          <OutcomeTable outcomes={view.outcomes} done={view.done} />
        </Card>
        {view.effects.length > 0 && (
          <Card title="Factors, those that matter most first">
            <FactorEffects effects={view.effects} />
          </Card>
        )}
      </div>
      <Card title={runsTitle(shown.length, runs.total, alike.size)} isWide>
        {alike.size > 0 && (
          <button type="button" className="command" onClick={() => setCause(undefined)}>
            Show all runs
          </button>
        )}
        {selected !== undefined && (
          <RunDetails key={selected} sweep={view.line.id} number={selected} mayOperate={mayOperate} onOpen={onOpenRecording} onClose={() => onSelect(undefined)} />
        )}
        <RunTable key={cause} runs={shown} factors={factors} selected={selected} onSelect={onSelect} />
      </Card>
      <Card title="Coverage" isWide>
        <MissedItems items={view.items} missing={view.missing} />
        <CoveredInputs inputs={view.inputs} />
      </Card>
    </div>
  )
}

function runsTitle(shown: number, total: number, alike: number): string {
  if (alike > 0) return `Runs with this cause: ${alike}`
  return shown < total ? `Runs, the first ${shown} of ${total}` : 'Runs, failing ones first'
}

function Card({ title, isWide = false, children }: { readonly title: string; readonly isWide?: boolean; readonly children: ReactNode }) {
  return (
    <section className={`sweep-card${isWide ? ' is-wide' : ''}`} aria-label={title}>
      <h2>{title}</h2>
      <ViewBoundary name={title}>{children}</ViewBoundary>
    </section>
  )
}

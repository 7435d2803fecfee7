/** Everything that a sweep has shown, as cards; a chosen cause or point leads to runs, a chosen run to itself. */
import { SimpleGrid, Stack } from '@mantine/core'
import { useMemo } from 'react'
import type { SweepRuns, SweepView } from '../../api/types'
import { requiredRate } from '../../document/sweeps'
import { BaselineChoice } from './BaselineChoice'
import { CoveredInputs } from './CoveredInputs'
import { Distributions } from './Distributions'
import { FactorEffects } from './FactorEffects'
import { MissedItems } from './MissedItems'
import { CauseList, OutcomeTable } from './Outcomes'
import { RateCurve } from './RateCurve'
import { Requirements } from './Requirements'
import { RunsCard, type RunsOf } from './RunsCard'
import { RunScatter } from './RunScatter'
import { SweepCard } from './SweepCard'
import { useRunsOfCause } from './useRunsOfCause'
import { PartTitle } from './Note'

export interface SweepReportProps extends Omit<RunsOf, 'sweep' | 'subject'> {
  readonly view: SweepView
  readonly runs: SweepRuns
}

export function SweepReport({ view, runs, ...of }: SweepReportProps) {
  const { cause, shown, factors, choose } = useRunsOfCause(runs)
  // Drawn over those that matter most.
  const ordered = useMemo(
    () => [...new Set([...view.effects.map((effect) => effect.address).filter((address) => address !== 'seed'), ...factors])],
    [view, factors],
  )
  if (view.done === 0) return null
  return (
    <SimpleGrid cols={{ base: 1, md: 2 }} spacing="sm" px={{ base: 'xs', md: 'md' }} pt="xs" pb="xl" style={{ alignItems: 'start' }}>
      <Stack gap="sm">
        <SweepCard title="Success rate after each run">
          <RateCurve curve={view.curve} required={requiredRate(view.document.require)} />
          <Requirements requirements={view.requirements} />
        </SweepCard>
        {factors.length > 0 && (
          <SweepCard title="Runs over two factors">
            <RunScatter runs={shown} factors={ordered} selected={of.selected} onSelect={of.onSelect} />
          </SweepCard>
        )}
        <SweepCard title="Distributions">
          <Distributions view={view} />
        </SweepCard>
      </Stack>
      <Stack gap="sm">
        <SweepCard title="How runs ended">
          {view.causes.length > 0 && (
            <>
              <PartTitle>Causes of failures</PartTitle>
              <CauseList causes={view.causes} chosen={cause} onChoose={choose} />
            </>
          )}
          <PartTitle>Outcomes</PartTitle>
          <OutcomeTable outcomes={view.outcomes} done={view.done} />
        </SweepCard>
        <SweepCard title="Compared with another version">
          <BaselineChoice key={view.subject} sweep={view.line.id} revision={view.done} onSelect={of.onSelect} />
        </SweepCard>
        {view.effects.length > 0 && (
          <SweepCard title="Factors, those that matter most first">
            <FactorEffects effects={view.effects} />
          </SweepCard>
        )}
      </Stack>
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
      <SweepCard title="Coverage" isWide>
        <MissedItems items={view.items} missing={view.missing} />
        <CoveredInputs inputs={view.inputs} />
      </SweepCard>
    </SimpleGrid>
  )
}

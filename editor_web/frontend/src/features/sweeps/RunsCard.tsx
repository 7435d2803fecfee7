/** The runs of a sweep, failing ones first, or those of one cause; and the one that is chosen. */
import { Button } from '@mantine/core'
import type { SweepRuns, TrialResult } from '../../api/types'
import { RunDetails } from './RunDetails'
import { RunTable } from './RunTable'
import { SweepCard } from './SweepCard'

export interface RunsOf {
  readonly sweep: string
  /** The hash of the versions that were executed. */
  readonly subject: string
  readonly mayOperate: boolean
  readonly selected: number | undefined
  readonly onSelect: (run: number | undefined) => void
  readonly onOpenRecording: (path: string) => void
  readonly onOpenSweep: (id: string) => void
}

export interface RunsCardProps extends RunsOf {
  readonly runs: SweepRuns
  readonly shown: readonly TrialResult[]
  readonly factors: readonly string[]
  /** An example of the cause whose runs are shown. */
  readonly cause: number | undefined
  readonly onShowAll: () => void
}

export function RunsCard({ runs, shown, factors, cause, onShowAll, selected, onSelect, onOpenRecording, ...of }: RunsCardProps) {
  return (
    <SweepCard title={runsTitle(shown.length, runs.total, cause !== undefined)} isWide>
      {cause !== undefined && (
        <Button size="compact-sm" variant="default" onClick={onShowAll}>
          Show all runs
        </Button>
      )}
      {selected !== undefined && (
        <RunDetails key={selected} {...of} number={selected} onOpen={onOpenRecording} onClose={() => onSelect(undefined)} />
      )}
      <RunTable key={cause} runs={shown} factors={factors} selected={selected} onSelect={onSelect} />
    </SweepCard>
  )
}

function runsTitle(shown: number, total: number, isOfCause: boolean): string {
  if (isOfCause) return `Runs with this cause: ${shown}`
  return shown < total ? `Runs, the first ${shown} of ${total}` : 'Runs, failing ones first'
}

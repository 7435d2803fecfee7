/** All active runs at once, each with its commands; those that ended last; and two of them to be compared. */
import { Box, Flex, SimpleGrid, Title } from '@mantine/core'
import { IconGitCompare, IconLayoutColumns, IconPlayerPlay } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { useData } from '../api/data'
import { useLive } from '../api/live'
import { clearRefusal, showRefusal } from '../api/refusal'
import type { LeaseMetrics, RunView } from '../api/types'
import { CommandButton } from '../components/CommandButton'
import { Empty } from '../components/Empty'
import { LiveOf } from '../components/LiveOf'
import { PageHead } from '../components/PageHead'
import { isActive } from '../document/runState'
import { RefusalLine } from '../features/control/RefusalLine'
import { Requests } from '../features/control/Requests'
import { RunButtons } from '../features/control/RunButtons'
import { useCommands } from '../features/control/useCommands'
import { FinishedRuns } from '../features/runs/FinishedRuns'
import { RunCard } from '../features/runs/RunCard'
import { nameOf } from '../features/runs/RunList'
import { InterruptedHere } from './InterruptedHere'
import { compareHref, sideBySideHref, runHref } from './route'
import { useBehavior } from './useBehavior'
import classes from './pages.module.css'

/** So many of those that are over are listed. */
const ENDED = 8
const CHOOSE = 'tick Compare at two runs first'
const CHOOSE_ENDED = 'tick Compare at two runs that have ended'

export function RunsPage({ onOpen }: { onOpen: (href: string) => void }) {
  const runs = useLive((s) => s.runs)
  const [chosen, setChosen] = useState<readonly string[]>([])
  const leases = useLeases()
  useEffect(clearRefusal, [])
  const active = runs.filter(isActive)
  const ended = runs.filter((run) => !isActive(run)).slice(0, ENDED)
  const pair = pairOf(
    chosen.filter((id) => runs.some((run) => run.id === id)),
    active,
  )
  const endedPair = pair?.every((id) => ended.some((run) => run.id === id)) ? olderFirst(pair, ended) : undefined
  const asking = active.filter((run) => run.waits === 'asks').length

  /** The two that were chosen last. */
  function choose(run: string, isChosen: boolean): void {
    const others = chosen.filter((each) => each !== run)
    setChosen(isChosen ? [...others, run].slice(-2) : others)
  }

  return (
    <Flex direction="column" flex={1} mih={0}>
      <PageHead title="Runs" words={wordsOf(active.length, asking)} isStatus>
        <CommandButton
          label="Side by side"
          hint="Graph and log of two runs side by side"
          icon={<IconLayoutColumns size={16} aria-hidden />}
          obstacle={pair ? undefined : CHOOSE}
          onObstacle={() => showRefusal('Side by side', CHOOSE)}
          onPress={() => pair && onOpen(sideBySideHref(...pair))}
        />
        <CommandButton
          label="Compare"
          hint="Visits, durations and values of two runs that have ended"
          icon={<IconGitCompare size={16} aria-hidden />}
          obstacle={endedPair ? undefined : CHOOSE_ENDED}
          onObstacle={() => showRefusal('Compare', CHOOSE_ENDED)}
          onPress={() => endedPair && onOpen(compareHref(...endedPair))}
        />
      </PageHead>
      <div className={classes.refusal}>
        <RefusalLine />
      </div>
      <Box flex={1} mih={0} bg="var(--ground)" style={{ overflow: 'auto' }}>
        <InterruptedHere onResumed={(run) => onOpen(runHref(run))}>
          {active.length === 0 ? (
            <Empty icon={<IconPlayerPlay size={26} stroke={1.4} aria-hidden />} title="No run is active">
              Choose a behavior in the menu and start it; several go on at once as long as no two need the same arm.
            </Empty>
          ) : (
            <SimpleGrid minColWidth="min(100%, 26rem)" spacing="sm" p="md">
              {active.map((run) => (
                <LiveOf key={run.id} run={run.id}>
                  <Card
                    run={run}
                    held={leases.filter((lease) => lease.run === run.id).map((lease) => lease.resource)}
                    isChosen={chosen.includes(run.id)}
                    onChoose={(isChosen) => choose(run.id, isChosen)}
                    onOpen={() => onOpen(runHref(run.id))}
                  />
                </LiveOf>
              ))}
            </SimpleGrid>
          )}
          {ended.length > 0 && (
            <section aria-labelledby="ended-runs">
              <Title order={2} id="ended-runs" mx="md" mt="3xs" mb="2xs" fz="0.82rem" fw={620} c="dimmed">
                Ended last
              </Title>
              <FinishedRuns runs={ended} href={runHref} onOpen={(run) => onOpen(runHref(run))} chosen={chosen} onChoose={choose} />
            </section>
          )}
        </InterruptedHere>
      </Box>
    </Flex>
  )
}

interface CardProps {
  readonly run: RunView
  readonly held: readonly string[]
  readonly isChosen: boolean
  readonly onChoose: (isChosen: boolean) => void
  readonly onOpen: () => void
}

function Card({ run, held, isChosen, onChoose, onOpen }: CardProps) {
  const name = nameOf(run.behavior)
  const root = useBehavior(run.behavior).value?.graph ?? null
  const commands = useCommands(run, undefined, name)
  return (
    <RunCard
      run={run}
      root={root}
      held={held}
      href={runHref(run.id)}
      onOpen={onOpen}
      isChosen={isChosen}
      onChoose={onChoose}
      requests={<Requests root={root} commands={commands} onShow={onOpen} of={name} />}
      commands={<RunButtons run={run} commands={commands} of={name} />}
    />
  )
}

function useLeases(): readonly LeaseMetrics[] {
  const [leases, setLeases] = useState<readonly LeaseMetrics[]>([])
  useData({ traffic: true }, (frame) => {
    if (frame.k === 'traffic') setLeases(frame.leases)
  })
  return leases
}

/** The two that were chosen; without a choice the only two that are under way. */
function pairOf(chosen: readonly string[], active: readonly RunView[]): readonly [string, string] | undefined {
  const [left, right] = chosen.length > 0 ? chosen : active.length === 2 ? active.map((run) => run.id) : []
  return left !== undefined && right !== undefined ? [left, right] : undefined
}

function olderFirst([one, other]: readonly [string, string], runs: readonly RunView[]): readonly [string, string] {
  const startS = (id: string) => runs.find((run) => run.id === id)?.started_at_s ?? 0
  return startS(one) <= startS(other) ? [one, other] : [other, one]
}

function wordsOf(active: number, asking: number): string {
  const going = active === 0 ? 'None is active' : active === 1 ? 'One is active' : `${active} are active`
  if (asking === 0) return going
  return `${going}, ${asking === 1 ? 'one asks' : `${asking} ask`}`
}

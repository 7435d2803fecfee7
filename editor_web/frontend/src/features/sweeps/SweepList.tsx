/** The sweeps of the project with what they have shown, and results that no document asks for. */
import { Box, Group, List, Progress, Text } from '@mantine/core'
import { IconChartDots } from '@tabler/icons-react'
import type { SweepLine, SweepList as Listed, UndescribedResults } from '../../api/types'
import { useLive } from '../../api/live'
import { Empty } from '../../components/Empty'
import { PageLink } from '../../components/PageLink'
import { StatusBadge } from '../../components/StatusBadge'
import { lookup } from '../../document/dict'
import { designText, failuresText } from '../../document/searches'
import { currentLive, intervalText, percent, rateOf, speedText, sweepName } from '../../document/sweeps'
import { VerdictBadge } from './VerdictBadge'
import { Mono, Note } from './Note'
import { shareDone } from './SweepControls'

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
    <List listStyleType="none" aria-label="Sweeps">
      {listed.sweeps.map((line) => (
        <Line key={line.id} line={line} href={href(line.id)} onOpen={() => onOpen(line.id)} />
      ))}
    </List>
  )
}

function Line({ line, href, onOpen }: { readonly line: SweepLine; readonly href: string; readonly onOpen: () => void }) {
  const reported = useLive((s) => lookup(s.sweeps, line.id))
  const live = currentLive(line, reported)
  const rate = rateOf(live)
  return (
    <Box component="li" py="sm" style={{ borderBottom: '1px solid var(--line)' }}>
      <Group gap="xs">
        <Text fz="1rem" fw={640} style={{ overflowWrap: 'anywhere' }}>
          <PageLink href={href} onOpen={onOpen}>
            {sweepName(line.id)}
          </PageLink>
        </Text>
        {live.status !== 'idle' && <StatusBadge look="active" words={live.status} />}
        <VerdictBadge live={live} require={line.require} />
      </Group>
      <Note isQuiet>{[line.description, line.behavior, designText(line)].filter(Boolean).join(' · ')}</Note>
      {line.problem ? (
        <Text fz="0.82rem" c="var(--failed)">
          {line.problem}
        </Text>
      ) : (
        <Group gap="md" my={2} fz="0.82rem" style={{ fontVariantNumeric: 'tabular-nums' }}>
          <span>
            {live.done} of {live.planned} runs
          </span>
          {live.search && live.done > 0 && <span>{failuresText(live.search)}</span>}
          {rate !== undefined && (
            <span>
              {percent(rate)} succeeded
              {live.interval && (
                <Text span inherit c="dimmed">
                  {' '}
                  ({intervalText(live.interval)})
                </Text>
              )}
            </span>
          )}
          {live.status === 'running' && (
            <Text span inherit c="dimmed">
              {speedText(live)}
            </Text>
          )}
        </Group>
      )}
      {!line.problem && (
        <Progress
          size="xs"
          maw="24rem"
          mt="3xs"
          value={shareDone(live)}
          aria-label={`${live.done} of ${live.planned} runs of ${sweepName(line.id)}`}
        />
      )}
    </Box>
  )
}

export function OtherResults({ others }: { readonly others: readonly UndescribedResults[] }) {
  return (
    <>
      <Note isQuiet>Of the command line, or of versions before a change. They stay until the file of results is deleted.</Note>
      <List listStyleType="none" aria-label="Results of no sweep here">
        {others.map((each) => (
          <Box component="li" py="sm" style={{ borderBottom: '1px solid var(--line)' }} key={each.subject}>
            <Note>
              {each.behavior || 'A version that is no longer here'} <Mono isQuiet>{each.subject.slice(0, 12)}</Mono>
            </Note>
            <Note isQuiet>
              {each.runs} {each.runs === 1 ? 'run' : 'runs'}, {each.successes} succeeded
            </Note>
          </Box>
        ))}
      </List>
    </>
  )
}

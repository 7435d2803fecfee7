/** The runs that ended last, one line each. */
import { Checkbox, Divider, Group, List, Paper, Text } from '@mantine/core'
import type { RunView } from '../../api/types'
import { RunBadge } from '../../components/StatusBadge'
import { RunTime } from '../../components/RunTime'
import { PageLink } from '../../components/PageLink'
import { isFailed } from '../../document/runState'
import { startTime, wallTime } from '../../document/time'
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
    <Paper withBorder radius="md" mx="md" mb="lg" bg="var(--surface)">
      <List listStyleType="none" aria-label="Runs that ended last">
        {runs.map((run, index) => (
          <li key={run.id}>
            {index > 0 && <Divider color="var(--line)" />}
            <Group gap="sm" px="sm" py="2xs" fz="0.84rem">
              <RunBadge run={run} />
              <PageLink href={href(run.id)} onOpen={() => onOpen(run.id)}>
                {nameOf(run.behavior)}
              </PageLink>
              <Text span inherit c="dimmed">
                {wallTime(run.started_at_s)}, <RunTime run={run} />
              </Text>
              {run.cause && (
                <Text span inherit truncate flex="1 1 12rem" c={isFailed(run) ? 'var(--failed)' : 'dimmed'} title={run.cause}>
                  {run.cause}
                </Text>
              )}
              <Checkbox
                ml="auto"
                size="xs"
                label="Compare"
                aria-label={`Compare ${nameOf(run.behavior)} of ${startTime(run, runs)}`}
                checked={chosen.includes(run.id)}
                onChange={(event) => onChoose(run.id, event.currentTarget.checked)}
              />
            </Group>
          </li>
        ))}
      </List>
    </Paper>
  )
}

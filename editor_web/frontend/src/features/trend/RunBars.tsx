/** The last runs of a behavior, newest first: a bar as long as the run took, in the colour of its end. */
import { Box, Checkbox, List, Progress, Text } from '@mantine/core'
import type { PastRun } from '../../api/types'
import { PageLink } from '../../components/PageLink'
import { RunTime } from '../../components/RunTime'
import { RunBadge } from '../../components/StatusBadge'
import { wallTime } from '../../document/time'
import styles from './trend.module.css'

interface RunBarsProps {
  readonly runs: readonly PastRun[]
  readonly href: (run: string) => string
  readonly onOpen: (run: string) => void
  readonly chosen: readonly string[]
  readonly onChoose: (run: string, isChosen: boolean) => void
}

export function RunBars({ runs, href, onOpen, chosen, onChoose }: RunBarsProps) {
  const longestS = Math.max(...runs.map((run) => run.duration_s), 1e-9)
  return (
    <Box h="100%" style={{ overflow: 'auto' }}>
      <List listStyleType="none" px="md" py="xs" className={styles.runs ?? ''} aria-label="Last runs">
        {runs.map((run) => (
          <li key={run.id}>
            <Checkbox
              size="xs"
              aria-label={`Compare the run of ${wallTime(run.started_at_s)}`}
              checked={chosen.includes(run.id)}
              onChange={(event) => onChoose(run.id, event.currentTarget.checked)}
            />
            <PageLink href={href(run.id)} title={run.cause} onOpen={() => onOpen(run.id)}>
              {wallTime(run.started_at_s)}
            </PageLink>
            <RunBadge run={run.status === 'running' ? { status: 'interrupted' } : run} />
            <Progress w="100%" size="md" value={(run.duration_s / longestS) * 100} color={`var(--${endOf(run)})`} aria-hidden />
            <Text span inherit ta="right" style={{ fontVariantNumeric: 'tabular-nums', whiteSpace: 'nowrap' }}>
              <RunTime run={run} />
            </Text>
          </li>
        ))}
      </List>
    </Box>
  )
}

function endOf(run: PastRun): 'done' | 'failed' | 'stopped' {
  if (run.success) return 'done'
  return run.status === 'finished' || run.status === 'errored' ? 'failed' : 'stopped'
}

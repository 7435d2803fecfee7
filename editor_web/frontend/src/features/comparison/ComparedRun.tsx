/** One of the two runs: which it is, how it ended, and the way to its page. */
import { Group, Text } from '@mantine/core'
import type { PastRun } from '../../api/types'
import { PageLink } from '../../components/PageLink'
import { RunTime } from '../../components/RunTime'
import { RunBadge } from '../../components/StatusBadge'
import type { Side } from '../../document/comparison'
import { wallTime } from '../../document/time'

interface ComparedRunProps {
  readonly side: Side
  readonly run: PastRun
  readonly href: string
  readonly onOpen: () => void
}

export function ComparedRun({ side, run, href, onOpen }: ComparedRunProps) {
  return (
    <Group gap="sm" px="md" py="xs" bg="var(--surface)" style={{ rowGap: 0 }} role="region" aria-label={`Run on the ${side}`}>
      <Text span inherit fw={620} c="dimmed">
        {side === 'left' ? 'Left' : 'Right'}
      </Text>
      <PageLink href={href} onOpen={onOpen}>
        {run.behavior}
      </PageLink>
      <RunBadge run={run.status === 'running' ? { status: 'interrupted' } : run} />
      <Text span inherit c="dimmed">
        {wallTime(run.started_at_s)}, <RunTime run={run} />
      </Text>
      {run.cause && (
        <Text span inherit truncate flex="1 1 100%" c="var(--failed)" title={run.cause}>
          {run.cause}
        </Text>
      )}
    </Group>
  )
}

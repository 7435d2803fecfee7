/** Above a recording that was made by executing a run of a sweep again: which one, and whether it was the same. */
import { Group } from '@mantine/core'
import { useReruns } from '../../api/sweeps'
import { PageLink } from '../../components/PageLink'
import { StatusIcon } from '../../components/StatusIcon'
import { lookup } from '../../document/dict'
import { sweepName } from '../../document/sweeps'
import { Mono } from './Note'

export interface RerunLineProps {
  readonly recording: string
  readonly href: (sweep: string, run: number) => string
  readonly onOpen: (sweep: string, run: number) => void
}

export function RerunLine({ recording, href, onOpen }: RerunLineProps) {
  const rerun = useReruns((s) => lookup(s.byRecording, recording))
  if (!rerun) return null
  const { sweep, rerun: recorded } = rerun
  const { number } = recorded.saved.configuration
  return (
    <Group
      gap="2xs"
      wrap="nowrap"
      px="md"
      py="3xs"
      fz="0.82rem"
      bg="var(--surface)"
      style={{ borderBottom: '1px solid var(--line)' }}
      role="status"
    >
      <StatusIcon status={recorded.same ? 'done' : 'warning'} size={15} />
      <span>
        <PageLink href={href(sweep, number)} onOpen={() => onOpen(sweep, number)}>
          Run {number} of {sweepName(sweep)}
        </PageLink>
        , executed again:{' '}
        {recorded.same
          ? `the same ${recorded.saved.events} events as in the sweep`
          : `NOT the same events as in the sweep (${recorded.result.events}, then ${recorded.saved.events})`}{' '}
        <Mono isQuiet>sha256 {recorded.result.events_sha256.slice(0, 12)}</Mono>
      </span>
    </Group>
  )
}

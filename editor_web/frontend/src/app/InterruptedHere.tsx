/** Runs of the shown behavior whose engine died, offered on top of its page. */
import { Box, Title } from '@mantine/core'
import { behaviorQueries } from '../api/behaviorQueries'
import { useLive } from '../api/live'
import { useAnswer } from '../api/queryClient'
import { lazyView } from '../components/lazyView'
import { Loading } from '../components/Loading'

/** Few starts find any. */
const Interrupted = lazyView(async () => (await import('../features/runs/Interrupted')).Interrupted)

export interface InterruptedHereProps {
  /** Name of the behavior that is shown; all runs where none is. */
  readonly behavior?: string | undefined
  readonly onResumed: (run: string) => void
}

export function InterruptedHere({ behavior, onResumed }: InterruptedHereProps) {
  const role = useLive((s) => s.role)
  const isConnected = useLive((s) => s.connection === 'live')
  const interrupted = useAnswer(behaviorQueries.interrupted())
  const runs = (interrupted.value ?? []).filter((run) => behavior === undefined || run.behavior === behavior)
  if (runs.length === 0) return null
  const obstacle = role === 'operator' ? undefined : 'you may look only; log in with the operator token'
  return (
    <Box
      component="section"
      aria-label="Interrupted runs"
      px={14}
      pb="sm"
      bg="var(--stopped-soft)"
      style={{ borderBottom: '1px solid var(--line)' }}
    >
      <Title order={2} fz="xs" py="3xs">
        Interrupted runs
      </Title>
      <Loading name="Interrupted runs">
        <Interrupted runs={runs} obstacle={isConnected ? obstacle : 'the server does not answer'} onResumed={onResumed} />
      </Loading>
    </Box>
  )
}

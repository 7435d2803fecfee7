/** Runs of the shown behavior whose engine died, offered on top of its page. */
import { Box, Title } from '@mantine/core'
import { api } from '../api/client'
import { useLive } from '../api/live'
import { Interrupted } from '../features/runs/Interrupted'
import { useFetched } from './useFetched'

export interface InterruptedHereProps {
  /** Name of the behavior that is shown; all runs where none is. */
  readonly behavior?: string | undefined
  readonly onResumed: (run: string) => void
}

export function InterruptedHere({ behavior, onResumed }: InterruptedHereProps) {
  // A resumed run is one more run of this server.
  const count = useLive((s) => s.runs.length)
  const role = useLive((s) => s.role)
  const isConnected = useLive((s) => s.connection === 'live')
  const interrupted = useFetched('interrupted', api.interrupted, count)
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
      <Interrupted runs={runs} obstacle={isConnected ? obstacle : 'the server does not answer'} onResumed={onResumed} />
    </Box>
  )
}

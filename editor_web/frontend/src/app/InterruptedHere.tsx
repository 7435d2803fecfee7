/** Runs of the shown behavior whose engine died, offered above its page, which waits for them so that nothing is pushed down. */
import { Box, Title } from '@mantine/core'
import { behaviorQueries } from '../api/behaviorQueries'
import { useLive } from '../api/live'
import { useAnswer } from '../api/queryClient'
import type { InterruptedRun } from '../api/types'
import { lazyView } from '../components/lazyView'
import { Loading } from '../components/Loading'
import { useEffect, useState, type ReactNode } from 'react'

/** Few starts find any. */
const Interrupted = lazyView(async () => (await import('../features/runs/Interrupted')).Interrupted)

export interface InterruptedHereProps {
  /** Name of the behavior that is shown; all runs where none is. */
  readonly behavior?: string | undefined
  readonly onResumed: (run: string) => void
  /** What is below them. */
  readonly children: ReactNode
}

/** A page does not wait for longer. */
const MOST_WAIT_MS = 1000

export function InterruptedHere({ behavior, onResumed, children }: InterruptedHereProps) {
  const interrupted = useAnswer(behaviorQueries.interrupted())
  const runs = (interrupted.value ?? []).filter((run) => behavior === undefined || run.behavior === behavior)
  const isLate = useIsLate()
  const isLoaded = useIsLoaded(runs.length > 0)
  const isKnown = interrupted.problem !== undefined || (interrupted.value !== undefined && (runs.length === 0 || isLoaded))
  const [wasKnown, setWasKnown] = useState(isKnown)
  if (isKnown && !wasKnown) setWasKnown(true)
  if (!isKnown && !wasKnown && !isLate) return null
  return (
    <>
      {runs.length > 0 && <InterruptedRuns runs={runs} onResumed={onResumed} />}
      {children}
    </>
  )
}

/** Whether the code of the view is there, or cannot be loaded, which the view says. */
function useIsLoaded(isNeeded: boolean): boolean {
  const [isLoaded, setLoaded] = useState(false)
  useEffect(() => {
    if (!isNeeded) return undefined
    let isShown = true
    const settled = () => isShown && setLoaded(true)
    Interrupted.load().then(settled, settled)
    return () => {
      isShown = false
    }
  }, [isNeeded])
  return isLoaded
}

function useIsLate(): boolean {
  const [isLate, setLate] = useState(false)
  useEffect(() => {
    const timer = setTimeout(() => setLate(true), MOST_WAIT_MS)
    return () => clearTimeout(timer)
  }, [])
  return isLate
}

function InterruptedRuns({ runs, onResumed }: { readonly runs: readonly InterruptedRun[]; readonly onResumed: (run: string) => void }) {
  const role = useLive((s) => s.role)
  const isConnected = useLive((s) => s.connection === 'live')
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

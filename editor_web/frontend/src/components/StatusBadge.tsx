/** A status in words as a small label. */
import { Badge } from '@mantine/core'
import { runStateOf, runWords, type RunFacts, type Status } from '../document/runState'
import type { ControlView } from '../api/types'
import { StatusIcon } from './StatusIcon'

export function StatusBadge({ look, words }: { readonly look: Status; readonly words: string }) {
  return (
    <Badge
      component="span"
      data-status={look}
      bg="var(--status-soft)"
      c="var(--status)"
      tt="none"
      fz="0.8rem"
      h="1.5rem"
      px="2xs"
      fw={600}
      leftSection={<StatusIcon status={look} size={13} />}
    >
      {words}
    </Badge>
  )
}

/** How a run is, or how it ended; `control` is that of the watched run. */
export function RunBadge({ run, control = null }: { readonly run: RunFacts | undefined; readonly control?: ControlView | null }) {
  return <StatusBadge look={runStateOf(run, control).look} words={runWords(run, control)} />
}

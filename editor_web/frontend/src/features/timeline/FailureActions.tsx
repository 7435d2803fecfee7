/** What can be done about a failure. */
import { Button, CopyButton, Group, Text } from '@mantine/core'
import { IconAdjustments, IconClipboardCopy, IconCube, IconPencil, IconRepeat, IconRestore } from '@tabler/icons-react'
import { useState } from 'react'
import { api, wordsOf } from '../../api/client'
import { lookAt, useLive } from '../../api/live'
import { originOf } from '../../api/origin'
import { mayMoveDevices } from '../../api/realDevices'
import type { RunFailure, RunView } from '../../api/types'
import { placesOf } from '../../document/failure'
import { isActive } from '../../document/runState'

export interface FailurePage {
  /** Id of the behavior that failed. */
  readonly behavior: string
  readonly mayOperate: boolean
  readonly hasView: boolean
  /** Open a state in the editor. */
  readonly onEdit?: ((path: string) => void) | undefined
  /** Show the parameters with which a run is started. */
  readonly onParameters?: (() => void) | undefined
  readonly onStarted?: ((run: string) => void) | undefined
}

export interface FailureActionsProps extends FailurePage {
  readonly run: RunView
  readonly failure: RunFailure
  readonly report: string
}

export function FailureActions(props: FailureActionsProps) {
  const { run, failure, report, behavior, mayOperate, hasView, onEdit, onParameters, onStarted } = props
  const isBusy = useLive((s) => s.runs.some(isActive))
  const robots = useLive((s) => s.robots)
  const [message, setMessage] = useState('')
  const isOff = isBusy ? 'A run is active' : undefined

  /** Say what came of it; nothing is done twice. */
  function attempt(words: string, request: () => Promise<unknown>): void {
    setMessage('')
    request().then(
      () => setMessage(words),
      (error: unknown) => setMessage(wordsOf(error)),
    )
  }

  async function retry(): Promise<void> {
    if (!(await mayMoveDevices())) throw new Error('Not started')
    const { seed } = await originOf(run.id)
    const begin = { run: run.id, seq: failure.entered_seq, path: failure.path }
    const started = await api.start({ behavior, seed, begin }, `retry ${run.id} ${Date.now()}`)
    onStarted?.(started.run)
  }

  return (
    <Group gap="xs" role="group" aria-label="What can be done">
      {hasView && (
        <Button {...LOOK} leftSection={<IconCube size={13} aria-hidden />} onClick={() => lookAt(placesOf(failure, Object.keys(robots)))}>
          Show place in 3D
        </Button>
      )}
      {mayOperate && hasView && (
        <Button
          {...LOOK}
          leftSection={<IconRestore size={13} aria-hidden />}
          disabled={isBusy}
          title={isOff}
          onClick={() => attempt('Parts are back', api.resetParts)}
        >
          Reset parts
        </Button>
      )}
      {mayOperate && onStarted && failure.entered_seq > 0 && (
        <Button
          {...LOOK}
          leftSection={<IconRepeat size={13} aria-hidden />}
          disabled={isBusy}
          title={isOff ?? `Start a new run at ${failure.path}, with the values it had there`}
          onClick={() => attempt('Started', retry)}
        >
          Retry from here
        </Button>
      )}
      {onEdit && failure.path && (
        <Button {...LOOK} leftSection={<IconPencil size={13} aria-hidden />} onClick={() => onEdit(failure.path)}>
          Open state
        </Button>
      )}
      {onParameters && (
        <Button {...LOOK} leftSection={<IconAdjustments size={13} aria-hidden />} onClick={onParameters}>
          Change parameters
        </Button>
      )}
      <CopyButton value={report}>
        {({ copied, copy }) => (
          <Button {...LOOK} leftSection={<IconClipboardCopy size={13} aria-hidden />} onClick={copy}>
            {copied ? 'Copied' : 'Copy report'}
          </Button>
        )}
      </CopyButton>
      <Text span role="status" size="sm" c="dimmed">
        {message}
      </Text>
    </Group>
  )
}

const LOOK = { variant: 'default', size: 'compact-xs' } as const

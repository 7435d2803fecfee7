/** Shrinks a failing run to the smallest change from nominal that still fails, and saves that as a test case. */
import { Button, Group, NativeSelect, Paper, Progress, Text } from '@mantine/core'
import { IconArrowsMinimize, IconPlayerStop } from '@tabler/icons-react'
import { useId, useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { sweepsApi } from '../../api/sweeps'
import type { ShrinkBody, Shrinking, TrialResult } from '../../api/types'
import { foundOf } from '../../document/searches'
import { ShrunkChange } from './ShrunkChange'
import { useShrinking } from './useShrinking'
import { Mono, Note, PartTitle } from './Note'

export interface ShrinkRunProps {
  readonly sweep: string
  readonly run: TrialResult
  readonly subject: string
  readonly mayOperate: boolean
  readonly onOpenSweep: (id: string) => void
}

type Same = NonNullable<ShrinkBody['same']>

export function ShrinkRun({ sweep, run, subject, mayOperate, onOpenSweep }: ShrinkRunProps) {
  const { number } = run.configuration
  const id = useId()
  const { shrinking, problem, request } = useShrinking(sweep, number)
  const [same, setSame] = useState<Same>('outcome')
  const found = foundOf(shrinking, subject, run.configuration)
  const isRunning = shrinking !== undefined && shrinking.status !== 'idle'
  const words = problem || shrinking?.problem
  if (!mayOperate && !found && !isRunning) return null
  return (
    <Paper
      component="section"
      withBorder
      radius="md"
      px="sm"
      py="2xs"
      my="xs"
      bg="var(--surface)"
      aria-label="The smallest change that fails"
    >
      <PartTitle>The smallest change that fails</PartTitle>
      {isRunning && (
        <ShrinkProgress
          shrinking={shrinking}
          mayOperate={mayOperate}
          onStop={() => void request(() => sweepsApi.stopShrinking(sweep, number))}
        />
      )}
      {!isRunning && found && shrinking && (
        <ShrunkChange
          sweep={sweep}
          number={number}
          found={found.shrunk}
          savedAs={shrinking.saved_as}
          onSave={mayOperate ? (file) => request(() => sweepsApi.saveCase(sweep, number, file)) : undefined}
          onOpenSweep={onOpenSweep}
        />
      )}
      {!isRunning && mayOperate && (
        <>
          <Group gap="xs" my="3xs">
            <Button
              size="compact-sm"
              variant="default"
              onClick={() => void request(() => sweepsApi.shrink(sweep, number, { same }))}
              leftSection={<IconArrowsMinimize size={15} aria-hidden />}
            >
              {found ? 'Shrink it again' : 'Shrink this run'}
            </Button>
            <Text component="label" htmlFor={id} fz="0.82rem">
              as long as
            </Text>
            <NativeSelect id={id} size="xs" value={same} onChange={(event) => setSame(event.currentTarget.value as Same)}>
              <option value="outcome">it ends the same way</option>
              <option value="cause">its root cause is the same too</option>
            </NativeSelect>
          </Group>
          {!found && (
            <Note isQuiet>
              Takes chance out, sets factors back to nominal, and moves the others towards it. That takes some tens of runs, in a process
              with a low priority.
            </Note>
          )}
        </>
      )}
      <Refusal>{words}</Refusal>
    </Paper>
  )
}

function ShrinkProgress({
  shrinking: { status, progress },
  mayOperate,
  onStop,
}: {
  readonly shrinking: Shrinking
  readonly mayOperate: boolean
  readonly onStop: () => void
}) {
  const isStopping = status === 'stopping'
  const runs = progress?.runs ?? 0
  return (
    <>
      <Group gap="xs" my="3xs">
        <Progress flex="1 1 12rem" size="sm" value={(100 * runs) / (progress?.most_runs ?? 1)} aria-label={`${runs} runs tried`} />
        {mayOperate && (
          <Button
            size="compact-sm"
            variant="default"
            c="var(--failed)"
            aria-disabled={isStopping || undefined}
            data-disabled={isStopping}
            onClick={() => !isStopping && onStop()}
            leftSection={<IconPlayerStop size={15} aria-hidden />}
          >
            {isStopping ? 'Stopping …' : 'Stop with the smallest so far'}
          </Button>
        )}
      </Group>
      <Note role="status">
        {progress ? `${progress.runs} of at most ${progress.most_runs} runs tried: ${progress.step}` : 'Loading what the runs need'}
      </Note>
      {progress && (
        <Note isQuiet>
          Still varied: <Mono>{progress.changed.join(', ') || 'nothing'}</Mono>
        </Note>
      )}
    </>
  )
}

/** One run of a sweep: how it ended, with which values, where its time went; and the run itself, executed again. */
import { ActionIcon, Alert, Anchor, Box, Button, Code, Group, Paper, SimpleGrid, Text, Title } from '@mantine/core'
import { IconPlayerPlay, IconX } from '@tabler/icons-react'
import { useEffect, useRef, useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { recordRun, sweepQueries } from '../../api/sweeps'
import type { RecordedTrial, TrialResult } from '../../api/types'
import { RunBadge } from '../../components/StatusBadge'
import { labelOf, short } from '../../document/sweeps'
import { duration } from '../../document/time'
import { ShrinkRun } from './ShrinkRun'
import { Chain, Note } from './Note'

const NODES = 8

export interface RunDetailsProps {
  readonly sweep: string
  readonly number: number
  /** The hash of the versions that were executed. */
  readonly subject: string
  readonly mayOperate: boolean
  readonly onOpen: (recording: string) => void
  readonly onOpenSweep: (id: string) => void
  readonly onClose: () => void
}

export function RunDetails({ sweep, number, subject, mayOperate, onOpen, onOpenSweep, onClose }: RunDetailsProps) {
  const { value: run, problem } = useAnswer(sweepQueries.run(sweep, number))
  const element = useRef<HTMLElement>(null)
  useEffect(() => {
    // A run may be chosen far from where it is told of. What this returns is no clean-up.
    element.current?.scrollIntoView({ block: 'nearest' })
  }, [run])
  return (
    <Paper
      component="section"
      ref={element}
      withBorder
      radius="md"
      px="sm"
      py="xs"
      mt="4xs"
      mb="sm"
      bg="var(--canvas)"
      style={{ scrollMargin: '80px 0 20px' }}
      aria-label={`Run ${number}`}
    >
      <Group gap="xs">
        <Title order={2} fz="0.92rem">
          Run {number}
        </Title>
        {run && <RunBadge run={run} />}
        <ActionIcon variant="subtle" color="gray" size="sm" ml="auto" aria-label={`Close run ${number}`} onClick={onClose}>
          <IconX size={15} aria-hidden />
        </ActionIcon>
      </Group>
      <Refusal>{problem}</Refusal>
      {run && (
        <>
          {run.cause && <Chain cause={run.cause} />}
          {mayOperate && <Again sweep={sweep} run={run} onOpen={onOpen} />}
          {!run.success && <ShrinkRun sweep={sweep} run={run} subject={subject} mayOperate={mayOperate} onOpenSweep={onOpenSweep} />}
          <Facts run={run} />
          <Note isQuiet>
            In a terminal:{' '}
            <Code>
              flexcell sweep rerun {sweep} {number}
            </Code>
            {!run.success && (
              <>
                {' '}
                and{' '}
                <Code>
                  flexcell sweep shrink {sweep} {number}
                </Code>
              </>
            )}
          </Note>
        </>
      )}
    </Paper>
  )
}

function Facts({ run }: { readonly run: TrialResult }) {
  const times = Object.entries(run.nodes)
    .map(([path, time]) => [path, time?.total_s ?? 0] as const)
    .toSorted((left, right) => right[1] - left[1])
  return (
    <SimpleGrid component="dl" minColWidth="15rem" spacing="lg" verticalSpacing={2} my="2xs" fz="0.82rem">
      <Fact name="duration" value={duration(run.duration_s)} />
      <Fact name="seed" value={String(run.configuration.seed)} />
      {Object.entries(run.configuration.values).map(([address, value]) => (
        <Fact key={address} name={address} value={short(value)} />
      ))}
      {times.slice(0, NODES).map(([path, seconds]) => (
        <Fact key={path} name={path} value={duration(seconds)} />
      ))}
      {Object.entries(run.measures).map(([key, value]) => (
        <Fact key={`measure ${key}`} name={key} value={short(value)} />
      ))}
      {Object.entries(run.outputs).map(([key, value]) => (
        <Fact key={`output ${key}`} name={`output ${key}`} value={short(value)} />
      ))}
    </SimpleGrid>
  )
}

function Fact({ name, value }: { readonly name: string; readonly value: string }) {
  return (
    <>
      <Text component="dt" inherit ff="monospace" c="dimmed" style={{ overflowWrap: 'anywhere' }}>
        {name}
      </Text>
      <Text component="dd" inherit m={0} style={{ fontVariantNumeric: 'tabular-nums' }}>
        {value}
      </Text>
    </>
  )
}

/** Executes the run again with recording; the recording opens by itself where the run was the same. */
function Again({
  sweep,
  run,
  onOpen,
}: {
  readonly sweep: string
  readonly run: TrialResult
  readonly onOpen: (recording: string) => void
}) {
  const [isAsking, setAsking] = useState(false)
  const [recorded, setRecorded] = useState<RecordedTrial>()
  const [problem, setProblem] = useState('')

  async function again(): Promise<void> {
    setAsking(true)
    setProblem('')
    try {
      const made = await recordRun(sweep, run.configuration.number)
      setRecorded(made)
      if (made.same && made.recording) onOpen(made.recording)
    } catch (error) {
      setProblem(wordsOf(error))
    }
    setAsking(false)
  }

  return (
    <Box my="2xs">
      <Button
        size="compact-sm"
        aria-disabled={isAsking || undefined}
        data-disabled={isAsking}
        onClick={() => !isAsking && void again()}
        leftSection={<IconPlayerPlay size={15} aria-hidden />}
      >
        {isAsking ? 'Executing it again …' : 'Open with graph, timeline and 3D'}
      </Button>
      <Note isQuiet role="status">
        {isAsking
          ? 'The run is executed again and recorded; it opens when it has ended.'
          : 'Executes this configuration again, and records it.'}
      </Note>
      {recorded && !recorded.same && (
        <Alert color="red" variant="light" p="xs">
          It ended differently this time: {labelOf(recorded.result)} with {recorded.result.events} events, before {labelOf(recorded.saved)}{' '}
          with {recorded.saved.events}.
          {recorded.recording && (
            <>
              {' '}
              <Anchor c="var(--accent)" component="button" inherit type="button" onClick={() => onOpen(recorded.recording)}>
                Open it anyway
              </Anchor>
            </>
          )}
        </Alert>
      )}
      <Refusal>{problem}</Refusal>
    </Box>
  )
}

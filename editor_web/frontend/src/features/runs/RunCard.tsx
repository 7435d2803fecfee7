/** One run among several: how it stands, what is active, what it waits for, what it holds, and its commands. */
import { Checkbox, Group, List, Paper, Stack, Text, Title } from '@mantine/core'
import type { ReactNode } from 'react'
import { useLive } from '../../api/live'
import { useNodePart } from '../../api/liveParts'
import type { GraphNode, RunView } from '../../api/types'
import { Elapsed } from '../../components/Elapsed'
import { RunTime } from '../../components/RunTime'
import { PageLink } from '../../components/PageLink'
import { StatusIcon } from '../../components/StatusIcon'
import { waitingWords } from '../../document/commands'
import { activeLeaves } from '../../document/runProgress'
import { runStateOf, type Status } from '../../document/runState'
import { wallTime } from '../../document/time'
import { pathWords } from '../../document/path'
import { nameOf } from './RunList'
import { RunStrip } from './RunStrip'

export interface RunCardProps {
  readonly run: RunView
  /** Its graph, where its document can be read. */
  readonly root: GraphNode | null
  /** The arms and devices that it commands. */
  readonly held: readonly string[]
  readonly href: string
  readonly onOpen: () => void
  /** Is it one of those that are to be shown side by side? */
  readonly isChosen: boolean
  readonly onChoose: (isChosen: boolean) => void
  /** What it asks. */
  readonly requests: ReactNode
  readonly commands: ReactNode
}

export function RunCard({ run, root, held, href, onOpen, isChosen, onChoose, requests, commands }: RunCardProps) {
  const control = useLive((s) => s.control)
  const name = nameOf(run.behavior)
  const state = runStateOf(run, control)
  return (
    <Paper
      component="article"
      withBorder
      radius="md"
      p="sm"
      miw={0}
      bg="var(--surface)"
      bd={`1px solid var(${run.waits ? '--stopped' : '--line'})`}
      aria-label={`Run of ${name} since ${wallTime(run.started_at_s)}`}
    >
      <Stack gap="xs" h="100%">
        <Group gap="xs" fz="0.84rem">
          <StatusIcon status={state.look} size={17} />
          <Title order={2} fz="1rem" style={{ overflowWrap: 'anywhere' }}>
            <PageLink href={href} onOpen={onOpen}>
              {name}
            </PageLink>
          </Title>
          <RunTime run={run} />
          <Text span inherit c="dimmed">
            since {wallTime(run.started_at_s)}
          </Text>
          <Checkbox
            ml="auto"
            size="xs"
            label="Compare"
            aria-label={`Compare ${name}`}
            checked={isChosen}
            onChange={(event) => onChoose(event.currentTarget.checked)}
          />
        </Group>
        <Text fz="0.84rem">
          <Text component="strong" inherit fw={700} c={colorOf(state.look)} role="status" aria-label={`State of ${name}`}>
            {state.word}
          </Text>
          {state.reason && (
            <Text span inherit c="dimmed">
              {' '}
              {state.reason}
            </Text>
          )}
        </Text>
        {root && <RunStrip root={root} />}
        <dl className="facts">
          <dt>Active</dt>
          <dd>
            <Active />
          </dd>
          <Waiting />
          <dt>Holds</dt>
          <dd>
            {held.length > 0 ? (
              held.join(', ')
            ) : (
              <Text span inherit c="dimmed">
                no arm or device
              </Text>
            )}
          </dd>
        </dl>
        {requests}
        {commands}
      </Stack>
    </Paper>
  )
}

/** What waits for somebody is amber, like what was stopped. */
function colorOf(look: Status): string {
  if (look === 'idle' || look === 'skipped') return 'var(--quiet)'
  return look === 'active' || look === 'done' || look === 'failed' ? `var(--${look})` : 'var(--stopped)'
}

function Active() {
  const active = useLive((s) => activeLeaves(s.nodes).join('\n'))
  if (!active)
    return (
      <Text span inherit c="dimmed">
        nothing
      </Text>
    )
  return (
    <List listStyleType="none" fz="inherit" aria-label="Active nodes">
      {active.split('\n').map((path) => (
        <ActiveNode key={path} path={path} />
      ))}
    </List>
  )
}

function ActiveNode({ path }: { path: string }) {
  const enteredS = useNodePart(path, (live) => live?.entered_s ?? 0)
  return (
    <li>
      <Text span inherit fw={600}>
        {pathWords(path)}
      </Text>{' '}
      <Elapsed sinceS={enteredS} />
    </li>
  )
}

/** What asks has its own place below. */
function Waiting() {
  const control = useLive((s) => s.control)
  const waiting = control?.waiting.filter((each) => !each.reasons.includes('autonomy')) ?? []
  if (waiting.length === 0) return null
  return (
    <>
      <dt>Waits</dt>
      <dd>
        <List listStyleType="none" fz="inherit" aria-label="Nodes that wait">
          {waiting.map((each) => (
            <li key={`${each.path}|${each.point}`}>
              {pathWords(each.path)} {waitingWords(each)}
            </li>
          ))}
        </List>
      </dd>
    </>
  )
}

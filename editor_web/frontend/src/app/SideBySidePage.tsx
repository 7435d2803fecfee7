/** Two runs beside one another, each with its commands, graph and log. */
import { Box, Divider, Flex, NativeSelect, Stack, VisuallyHidden } from '@mantine/core'
import { IconLayoutColumns } from '@tabler/icons-react'
import { useEffect, useState, type ReactNode } from 'react'
import { Group, Panel as Pane } from 'react-resizable-panels'
import { useLive } from '../api/live'
import { clearRefusal } from '../api/refusal'
import type { RunView } from '../api/types'
import { Empty } from '../components/Empty'
import { LiveOf } from '../components/LiveOf'
import { PageLink } from '../components/PageLink'
import { Splitter } from '../components/Splitter'
import { ViewBoundary } from '../components/ViewBoundary'
import { isActive } from '../document/runState'
import { nodeAt } from '../document/tree'
import { wallTime } from '../document/time'
import { RefusalLine } from '../features/control/RefusalLine'
import { RunBar } from '../features/control/RunBar'
import { StopRun } from '../features/control/RunButtons'
import { StatusRow } from '../features/control/StatusRow'
import { useCommands } from '../features/control/useCommands'
import { Graph, type Shown } from '../features/graph/Graph'
import { EventLog } from '../features/log/EventLog'
import { nameOf } from '../features/runs/RunList'
import { Breadcrumb } from './Breadcrumb'
import { sideBySideHref, runHref } from './route'
import { useBehavior } from './useBehavior'
import classes from './pages.module.css'

export interface SideBySidePageProps {
  readonly left: string
  readonly right: string
  readonly isNarrow: boolean
  readonly onOpen: (href: string) => void
}

export function SideBySidePage({ left, right, isNarrow, onOpen }: SideBySidePageProps) {
  useEffect(clearRefusal, [left, right])
  const column = (id: string, side: Side, other: string) => (
    <Column
      id={id}
      side={side}
      other={other}
      onChange={(run) => onOpen(side === 'left' ? sideBySideHref(run, right) : sideBySideHref(left, run))}
      onOpen={onOpen}
    />
  )
  return (
    <Flex direction="column" flex={1} mih={0}>
      <VisuallyHidden component="h1">Two runs side by side</VisuallyHidden>
      <div className={classes.refusal}>
        <RefusalLine />
      </div>
      {isNarrow ? (
        <Box flex={1} mih={0} style={{ overflow: 'auto' }}>
          <Box h="88dvh">{column(left, 'left', right)}</Box>
          <Divider size="md" color="var(--line-strong)" />
          <Box h="88dvh">{column(right, 'right', left)}</Box>
        </Box>
      ) : (
        <Group orientation="horizontal" style={{ flex: 1, minHeight: 0 }}>
          <Pane id="left-run" defaultSize="50%" minSize="25%">
            {column(left, 'left', right)}
          </Pane>
          <Splitter label="Width of the left run" />
          <Pane id="right-run" defaultSize="50%" minSize="25%">
            {column(right, 'right', left)}
          </Pane>
        </Group>
      )}
    </Flex>
  )
}

function ColumnHead({ children }: { readonly children: ReactNode }) {
  return (
    <Flex
      component="header"
      wrap="wrap"
      align="center"
      rowGap="4xs"
      columnGap="xs"
      mih={46}
      px="sm"
      py="3xs"
      fz="0.84rem"
      style={{ borderBottom: '1px solid var(--line)' }}
    >
      {children}
    </Flex>
  )
}

type Side = 'left' | 'right'

interface ColumnProps {
  readonly id: string
  readonly side: Side
  /** The run of the other column, which is not offered here. */
  readonly other: string
  readonly onChange: (run: string) => void
  readonly onOpen: (href: string) => void
}

function Column({ id, side, other, onChange, onOpen }: ColumnProps) {
  const runs = useLive((s) => s.runs)
  const knowsRuns = useLive((s) => s.knowsRuns)
  const run = runs.find((each) => each.id === id)
  const choice = <RunChoice runs={runs.filter((each) => each.id !== other)} id={id} side={side} onChange={onChange} />
  if (run) {
    return (
      <LiveOf key={run.id} run={run.id}>
        <ViewBoundary name={`The run on the ${side}`}>
          <RunColumn run={run} side={side} choice={choice} onOpen={() => onOpen(runHref(run.id))} />
        </ViewBoundary>
      </LiveOf>
    )
  }
  return (
    <Stack component="section" gap={0} h="100%" miw={0} mih={0} bg="var(--surface)" aria-label={`Run on the ${side}`}>
      <ColumnHead>{choice}</ColumnHead>
      {knowsRuns && (
        <Empty icon={<IconLayoutColumns size={26} stroke={1.4} aria-hidden />} title="No run is shown here">
          {id ? 'This server knows no such run; choose another one.' : 'Choose one.'}
        </Empty>
      )}
    </Stack>
  )
}

interface RunChoiceProps {
  readonly runs: readonly RunView[]
  readonly id: string
  readonly side: Side
  readonly onChange: (run: string) => void
}

function RunChoice({ runs, id, side, onChange }: RunChoiceProps) {
  const isKnown = runs.some((run) => run.id === id)
  return (
    <NativeSelect
      size="xs"
      maw="100%"
      aria-label={`Which run on the ${side}`}
      value={isKnown ? id : ''}
      onChange={(event) => onChange(event.currentTarget.value)}
    >
      {!isKnown && <option value="">Choose a run</option>}
      {runs.map((run) => (
        <option key={run.id} value={run.id}>
          {nameOf(run.behavior)}, {wallTime(run.started_at_s)}
          {isActive(run) ? '' : `, ${run.outcome ?? run.status}`}
        </option>
      ))}
    </NativeSelect>
  )
}

interface RunColumnProps {
  readonly run: RunView
  readonly side: Side
  readonly choice: ReactNode
  readonly onOpen: () => void
}

function RunColumn({ run, side, choice, onOpen }: RunColumnProps) {
  const [selected, setSelected] = useState<string>()
  const [shown, setShown] = useState<Shown>()
  const behavior = useBehavior(run.behavior)
  const root = behavior.value?.graph ?? null
  const name = `${nameOf(run.behavior)} on the ${side}`
  const commands = useCommands(run, root && selected ? nodeAt(root, selected)?.path : undefined, name)

  function show(path: string): void {
    setSelected(path)
    setShown({ path })
  }

  return (
    <Stack component="section" gap={0} h="100%" miw={0} mih={0} bg="var(--surface)" aria-label={`Run on the ${side}`}>
      <ColumnHead>
        {choice}
        <Box flex={1} />
        <PageLink href={runHref(run.id)} onOpen={onOpen}>
          Whole page
        </PageLink>
        {isActive(run) && <StopRun commands={commands} />}
      </ColumnHead>
      {isActive(run) && <RunBar run={run} commands={commands} of={name} />}
      <StatusRow run={run} root={root} commands={commands} onShow={show} of={name} />
      <Group orientation="vertical" style={{ flex: 1, minHeight: 0 }}>
        <Pane id={`${side}-graph`} defaultSize="60%" minSize="20%">
          {root ? (
            <Graph
              root={root}
              selected={selected}
              onSelect={setSelected}
              shown={shown}
              document={run.behavior}
              of={name}
              breadcrumb={<Breadcrumb selected={selected} onSelect={show} />}
            />
          ) : (
            behavior.problem && <Empty title="This behavior cannot be shown">{behavior.problem}</Empty>
          )}
        </Pane>
        <Splitter isFlat label={`Height of the graph on the ${side}`} />
        <Pane id={`${side}-log`} defaultSize="40%" minSize="15%">
          <EventLog of={name} />
        </Pane>
      </Group>
    </Stack>
  )
}

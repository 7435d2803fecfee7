/** A past run or a recording, read-only: the same view as of a run under way, from its beginning to its end. */
import { Button, Flex, Text } from '@mantine/core'
import { IconGitCompare, IconTrendingUp } from '@tabler/icons-react'
import { useEffect, useMemo, useState } from 'react'
import { openSubject, pastApi, recordingSubject, runSubject, useTimeline } from '../api/timeline'
import { hasCellView } from '../api/session'
import type { OpenRunBody, SessionBody } from '../api/types'
import { Empty } from '../components/Empty'
import { OpenedTabs } from '../components/OpenedTabs'
import { PageHead } from '../components/PageHead'
import { Panel } from '../components/Panel'
import { RunBadge } from '../components/StatusBadge'
import { TextButton } from '../components/TextButton'
import { duration, wallTime } from '../document/time'
import { nodeAt } from '../document/tree'
import { CellFrame } from '../features/cell/CellFrame'
import { Graph, type Shown } from '../features/graph/Graph'
import { Outline } from '../features/graph/Outline'
import { Selection } from '../features/graph/Selection'
import { RerunLine } from '../features/sweeps/RerunLine'
import { PastLine } from '../features/timeline/PastLine'
import { Breadcrumb } from './Breadcrumb'
import { pastBodies } from './dock'
import { LayoutChoice } from './LayoutChoice'
import { compareHref, LAST_GOOD, runHref, sweepHref, trendHref } from './route'
import { useRunLayout } from './runLayout'
import { useFetched } from './useFetched'
import { useMomentAddress } from './useMomentAddress'
import { TabBody, Wide } from './WorkSpace'

export interface PastPageProps {
  /** The run, or the path of the recording. */
  readonly id: string
  readonly isRecording: boolean
  readonly session: SessionBody | undefined
  readonly isNarrow: boolean
  readonly onAll: () => void
  readonly onOpen: (href: string) => void
}

export function PastPage(props: PastPageProps) {
  const { id, isRecording } = props
  const fetched = useFetched(`${isRecording} ${id}`, () => (isRecording ? pastApi.openRecording(id) : pastApi.openRun(id)))
  if (fetched.problem) {
    return (
      <Empty title={isRecording ? 'This recording cannot be opened' : 'This run cannot be opened'}>
        {fetched.problem}
        <br />
        <TextButton onPress={props.onAll}>All past runs</TextButton>
      </Empty>
    )
  }
  if (!fetched.value) return <div role="status" aria-label="Loading" />
  return <Opened {...props} opened={fetched.value} />
}

function Opened({ id, isRecording, session, isNarrow, onAll, onOpen, opened }: PastPageProps & { opened: OpenRunBody }) {
  const { run, behavior } = opened
  const [selected, setSelected] = useState<string>()
  const [shown, setShown] = useState<Shown>()
  const isOpen = useTimeline((s) => s.opened !== undefined)
  const hasView = hasCellView(session)
  const [layout, setLayout] = useRunLayout(hasView)
  const node = behavior.graph && selected ? nodeAt(behavior.graph, selected) : undefined

  const subject = useMemo(() => (isRecording ? recordingSubject(id, run.id) : runSubject(id, true)), [id, isRecording, run.id])
  useEffect(() => openSubject(subject), [subject])
  useMomentAddress(subject, selected, show)

  // What stands in the page asks for the timeline of what is opened.
  if (!isOpen) return null

  function show(path: string): void {
    setSelected(path)
    setShown({ path })
  }

  const graph = behavior.graph ? (
    <Graph
      root={behavior.graph}
      selected={selected}
      onSelect={setSelected}
      shown={shown}
      breadcrumb={<Breadcrumb selected={selected} onSelect={show} />}
    />
  ) : (
    <Panel title="Graph">
      <Empty title="There is no graph to draw">The executed behavior is unknown; its events are below.</Empty>
    </Panel>
  )
  const cell = (
    <Panel title="Cell" hasIcons>
      <CellFrame />
    </Panel>
  )
  const outline = (
    <TabBody isFlush>
      {behavior.graph && <Outline root={behavior.graph} selected={selected} onSelect={show} />}
      {node && <Selection node={node} />}
    </TabBody>
  )
  const page = {
    behavior: behavior.id,
    mayOperate: session?.role === 'operator',
    hasView,
    // The file may have changed since, and may be gone: what is executed then is what it says now.
    onStarted: isRecording ? undefined : (started: string) => onOpen(runHref(started)),
  }
  const dock = pastBodies({ behavior, run, node: selected, session, onShow: show, page }, run.failed)
  return (
    <Flex direction="column" flex={1} mih={0}>
      <PageHead
        title={behavior.name || run.behavior}
        words={`${isRecording ? `Recording ${id}` : 'Past run'} of ${wallTime(run.started_at_s)}, ${duration(run.duration_s)}, read-only`}
        state={
          <>
            <RunBadge run={run} />
            {run.cause && (
              <Text truncate fz="0.84rem" miw={0} c="var(--failed)" title={run.cause}>
                {run.cause}
              </Text>
            )}
          </>
        }
      >
        {hasView && !isNarrow && <LayoutChoice layout={layout} onLayout={setLayout} />}
        <Button
          variant="default"
          size="xs"
          leftSection={<IconGitCompare size={15} aria-hidden />}
          onClick={() => onOpen(compareHref(LAST_GOOD, id))}
        >
          Compare with the last good run
        </Button>
        <Button
          variant="default"
          size="xs"
          leftSection={<IconTrendingUp size={15} aria-hidden />}
          onClick={() => onOpen(trendHref(run.behavior))}
        >
          Last runs
        </Button>
        <Button variant="default" size="xs" onClick={onAll}>
          All past runs
        </Button>
      </PageHead>
      {isRecording && <RerunLine recording={id} href={sweepHref} onOpen={(sweep, number) => onOpen(sweepHref(sweep, number))} />}
      <PastLine run={run} hasCellView={hasView} />
      {isNarrow ? (
        <OpenedTabs label="Views" bodies={{ ...dock.all, Graph: graph, Cell: cell, Outline: outline }} />
      ) : (
        <Wide
          arrangement={layout}
          graph={graph}
          cell={cell}
          tabs={
            layout === 'debug' ? (
              <Panel title="Outline">{outline}</Panel>
            ) : (
              <OpenedTabs label="Below the graph" bodies={{ ...dock.all, Outline: outline }} />
            )
          }
          course={<OpenedTabs label="Course of the run" bodies={dock.course} isDock />}
          records={<OpenedTabs label="Records of the run" bodies={dock.records} isDock />}
        />
      )}
    </Flex>
  )
}

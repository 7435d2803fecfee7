/** The page of a behavior: head, run control, graph, log, cell, parameters, outline and problems. */
import { Box, Button, Flex } from '@mantine/core'
import { IconPencil } from '@tabler/icons-react'
import { useEffect, useMemo, useState } from 'react'
import { loadSavedBreakpoints, toggleBreakpoint, useBreakpoints } from '../api/breakpoints'
import { useLive } from '../api/live'
import { useGoalsOf } from '../api/goals'
import { clearRefusal, showRefusal } from '../api/refusal'
import { hasCellView } from '../api/session'
import { useStartHere } from '../api/startHere'
import { showPresence } from '../api/presence'
import { runSubject } from '../api/timeline'
import type { BehaviorView, RunView, SessionBody } from '../api/types'
import { Empty } from '../components/Empty'
import { WhileLoading, lazyView } from '../components/lazyView'
import { OpenedTabs } from '../components/OpenedTabs'
import { PageHead } from '../components/PageHead'
import { Panel } from '../components/Panel'
import { ViewBoundary } from '../components/ViewBoundary'
import { proposedRequest } from '../document/plannedPaths'
import { isActive, isFailed } from '../document/runState'
import { hasErrors, startObstacle } from '../document/startObstacle'
import { nodeAt } from '../document/tree'
import { AdaptHere } from '../features/adaptation/AdaptHere'
import { CellFrame } from '../features/cell/CellFrame'
import { ResetParts } from '../features/cell/ResetParts'
import { ShowMenu } from '../features/cell/ShowMenu'
import { Breakpoints } from '../features/control/Breakpoints'
import { ChangeReport } from '../features/control/ChangeReport'
import { goToCondition } from '../features/control/goToCondition'
import { Holds } from '../features/control/Holds'
import { FORCE_ID, NodeCard } from '../features/control/NodeCard'
import { PathScrubber } from '../features/control/PathScrubber'
import { RefusalLine } from '../features/control/RefusalLine'
import { REQUESTS_ID } from '../features/control/Requests'
import { RunBar } from '../features/control/RunBar'
import { StatusRow } from '../features/control/StatusRow'
import { useCommands, type Commands } from '../features/control/useCommands'
import { useRunKeys } from '../features/control/useRunKeys'
import { FindingList } from '../features/findings/FindingList'
import { Graph, type Shown } from '../features/graph/Graph'
import { Outline } from '../features/graph/Outline'
import { Selection } from '../features/graph/Selection'
import { Breadcrumb } from './Breadcrumb'
import { dockBodies } from './dock'
import { LayoutChoice } from './LayoutChoice'
import classes from './pages.module.css'
import { useRunLayout, type RunLayout } from './runLayout'
import { InterruptedHere } from './InterruptedHere'
import { ParameterForm } from '../features/parameters/ParameterForm'
import { StartButton } from '../features/parameters/StartButton'
import { StartProvider } from '../features/parameters/StartProvider'
import { BlockedPaths } from '../features/robots/BlockedPaths'
import { RobotStrip } from '../features/robots/RobotStrip'
import { PastLine } from '../features/timeline/PastLine'
import { useBehavior } from './useBehavior'
import { useMomentAddress } from './useMomentAddress'
import { NarrowGraph, SideTabs, TabBody, Wide, type Arrangement, type Tab } from './WorkSpace'

const StartHereDialog = lazyView(async () => (await import('../features/parameters/StartHereDialog')).StartHereDialog)

export interface BehaviorPageProps {
  readonly id: string
  /** The run that is shown, if any. */
  readonly run: RunView | undefined
  /** All active runs. */
  readonly active: readonly RunView[]
  readonly session: SessionBody | undefined
  readonly isNarrow: boolean
  readonly onStarted: () => void
  /** Open the editor, at a node where one is chosen. */
  readonly onEdit: (node: string) => void
  /** Open another behavior in the editor. */
  readonly onMade: (id: string) => void
}

export function BehaviorPage(props: BehaviorPageProps) {
  const { id } = props
  const generation = useLive((s) => s.generation)
  const fetched = useBehavior(id)
  useEffect(() => {
    clearRefusal()
    void loadSavedBreakpoints(id)
  }, [id, generation])
  if (fetched.problem) return <Empty title="This behavior cannot be shown">{fetched.problem}</Empty>
  if (!fetched.value) return <div role="status" aria-label="Loading" />
  return (
    <StartProvider behavior={fetched.value} onStarted={props.onStarted}>
      <Loaded {...props} behavior={fetched.value} />
    </StartProvider>
  )
}

function Loaded({ behavior, run, active, session, isNarrow, onStarted, onEdit, onMade }: BehaviorPageProps & { behavior: BehaviorView }) {
  const [selected, setSelected] = useState<string>()
  const [shown, setShown] = useState<Shown>()
  const [tab, setTab] = useState<Tab>(hasErrors(behavior) ? 'problems' : 'parameters')
  const [askedTab, askTab] = useState<{ readonly tab: string }>()
  const hasView = hasCellView(session)
  const { layout, arrangement, setLayout } = useArrangement(hasView)
  const isConnected = useLive((s) => s.connection === 'live')
  const stop = useLive((s) => s.stop)
  const obstacle = isConnected ? startObstacle(behavior, active, session, stop) : 'The server does not answer'
  const node = behavior.graph && selected ? nodeAt(behavior.graph, selected) : undefined
  const commands = useCommands(run, node?.path)
  const isStartAsked = useStartHere((s) => s.asked !== undefined)
  const holds = useBreakpoints().length + useLive((s) => s.control?.locks.length ?? 0)
  const mayOperate = session?.role === 'operator'
  useGoalsOf(run && isActive(run) ? run.id : undefined)
  useEffect(() => showPresence({ node: selected ?? '' }), [selected])
  useFailed(run, () => {
    setTab('failure')
    askTab({ tab: 'Failure' })
  })

  /** Choose a node on the canvas: what can be done with it comes forward. */
  function choose(path: string | undefined): void {
    setSelected(path)
    if (path) setTab('node')
    else if (tab === 'node') setTab('parameters')
  }

  function show(path: string): void {
    choose(path)
    setShown({ path })
  }

  const runId = run?.id
  useMomentAddress(
    useMemo(() => (runId ? runSubject(runId) : undefined), [runId]),
    selected,
    show,
  )
  useRunKeys({
    pause: commands.pauseOrResume,
    into: () => commands.step('into'),
    over: () => commands.step('over'),
    out: () => commands.step('out'),
    back: commands.stepBack,
    stop: commands.stop,
    break: () => withNode('Breakpoint', 'breakpoint', (path) => void toggleBreakpoint(path)),
    condition: () =>
      withNode('Breakpoint', 'breakpoint', (path) => {
        setTab('node')
        void goToCondition(path)
      }),
    lock: () =>
      withNode('Lock', 'lock', (path) => {
        const isLocked = useLive.getState().control?.locks.includes(path)
        void (isLocked ? commands.unlock(path) : commands.lock(path, ''))
      }),
    repeat: () => withNode('Run again', 'repeat', (path) => void commands.repeat(path)),
    force: () => withNode('Force', 'force', () => focusFirst(FORCE_ID)),
    answer: () => focusFirst(REQUESTS_ID) || showRefusal('Answer', 'the run asks nothing'),
    waiting: () => {
      const waiting = useLive.getState().control?.waiting[0]
      if (waiting) show(waiting.path)
      else showRefusal('Go to a node that waits', 'no node waits')
    },
  })

  function showParameters(): void {
    if (arrangement === '3d') setLayout('operate')
    setTab('parameters')
  }

  /** The view of the failure comes forward, where the layout has it. */
  function showFailure(): void {
    if (layout === '3d') setLayout('operate')
    setTab('failure')
    askTab({ tab: 'Failure' })
  }

  function withNode(words: string, command: Parameters<Commands['obstacle']>[0], act: (path: string) => void): void {
    const why = commands.obstacle(command)
    if (why || !node) showRefusal(words, why ?? 'select a node in the graph first')
    else act(node.path)
  }

  const breakpointForm = (path: string) => <Breakpoints path={path} isOff={commands.obstacle('breakpoint')} />
  const card = node && <NodeCard node={node} behavior={behavior.id} commands={commands} />
  const graph = behavior.graph ? (
    <Graph
      root={behavior.graph}
      selected={selected}
      onSelect={choose}
      shown={shown}
      behavior={behavior.id}
      document={behavior.id}
      breakpointForm={breakpointForm}
      breadcrumb={<Breadcrumb selected={selected} onSelect={show} />}
    />
  ) : (
    <Panel title="Graph">
      <Empty title="There is no graph to draw">The document cannot be read; see its problems.</Empty>
    </Panel>
  )
  const cell = (
    <Panel
      title="Cell"
      hasIcons
      tools={
        <>
          <Box flex={1} />
          {hasView && <ShowMenu />}
          {mayOperate && <ResetParts isBusy={active.length > 0} />}
        </>
      }
      foot={
        <>
          {hasView && <PathScrubber />}
          <RobotStrip />
        </>
      }
    >
      <CellFrame />
    </Panel>
  )
  const parameters = (
    <TabBody>
      <ParameterForm
        behavior={behavior}
        place={placeOf(
          session,
          active.filter((each) => each.behavior !== behavior.id),
        )}
        terminal={`flexcell run ${behavior.id} --clock virtual`}
        run={run?.id}
      />
    </TabBody>
  )
  const nodeTab = (
    <TabBody isFlush>
      {node ? (
        <>
          {card}
          <Selection node={node} />
        </>
      ) : (
        <Empty title="No node is selected">Click a node in the graph, or select one in the outline.</Empty>
      )}
    </TabBody>
  )
  const page = {
    behavior: behavior.id,
    mayOperate,
    hasView,
    onEdit,
    onParameters: showParameters,
    onStarted,
  }
  const dock = dockBodies({ behavior, run, node: node?.path, session, onShow: show, page })
  const outline = (
    <TabBody isFlush>
      {behavior.graph && <Outline root={behavior.graph} selected={selected} onSelect={setSelected} />}
      {node && <Selection node={node} />}
    </TabBody>
  )
  const held = (
    <TabBody>
      <Holds commands={commands} onShow={show} />
    </TabBody>
  )
  const problems = (
    <TabBody>
      <FindingList document={behavior.id} findings={behavior.findings} onSelect={show} />
    </TabBody>
  )

  return (
    <Flex direction="column" flex={1} mih={0}>
      <PageHead title={behavior.name} words={behavior.description}>
        {hasView && !isNarrow && <LayoutChoice layout={arrangement === 'approval' ? undefined : layout} onLayout={setLayout} />}
        <Button variant="default" size="sm" leftSection={<IconPencil size={15} aria-hidden />} onClick={() => onEdit(selected ?? '')}>
          Edit
        </Button>
        <StartButton obstacle={obstacle} onWrong={showParameters} />
      </PageHead>
      <ViewBoundary name="Adapt">
        <AdaptHere behavior={behavior.id} obstacle={behavior.fit.obstacle} mayEdit={mayOperate} onMade={onMade} />
      </ViewBoundary>
      <InterruptedHere behavior={behavior.name} onResumed={onStarted}>
        <ViewBoundary name="Run control">
          <RunBar run={run} commands={commands} hasKeys />
        </ViewBoundary>
        <ViewBoundary name="Status">
          <StatusRow
            run={run}
            root={behavior.graph}
            commands={commands}
            onShow={show}
            onFailure={showFailure}
            notices={<BlockedPaths isLine />}
          />
        </ViewBoundary>
        <ViewBoundary name="Timeline">
          <PastLine run={run} hasCellView={hasView} />
        </ViewBoundary>
        <div className={classes.refusal}>
          <RefusalLine />
        </div>
        {isNarrow ? (
          <OpenedTabs
            label="Views"
            bodies={{
              Start: parameters,
              Graph: <NarrowGraph graph={graph} card={card} />,
              Cell: cell,
              ...dock.all,
              Outline: outline,
              Breakpoints: held,
              Problems: problems,
            }}
          />
        ) : (
          <Wide
            arrangement={arrangement}
            graph={graph}
            course={<OpenedTabs label="Course of the run" bodies={dock.course} isDock asked={askedTab} />}
            records={<OpenedTabs label="Records of the run" bodies={dock.records} isDock />}
            cell={cell}
            tabs={
              <SideTabs
                tab={tab}
                onTab={setTab}
                counts={{ holds, problems: behavior.findings.length }}
                bodies={
                  arrangement === 'debug'
                    ? { parameters, node: nodeTab, outline, holds: held, problems }
                    : { parameters, node: nodeTab, log: dock.all.Log, failure: dock.all.Failure, problems }
                }
              />
            }
          />
        )}
      </InterruptedHere>
      <ChangeReport commands={commands} />
      {isStartAsked && (
        <ViewBoundary name="Start here">
          <WhileLoading value={null}>
            <StartHereDialog behavior={behavior} obstacle={obstacle} onStarted={onStarted} />
          </WhileLoading>
        </ViewBoundary>
      )}
    </Flex>
  )
}

/** Called when a run fails that was seen under way. */
function useFailed(run: RunView | undefined, onFailed: () => void): void {
  const [seen, setSeen] = useState<string>()
  const failed = run && !isActive(run) && isFailed(run) ? run.id : undefined
  const active = isActive(run) ? run?.id : undefined
  if (active !== undefined && active !== seen) setSeen(active)
  useEffect(() => {
    if (failed !== undefined && failed === seen) onFailed()
    // eslint-disable-next-line react-hooks/exhaustive-deps -- called once for each run
  }, [failed, seen])
}

/** The layout that was chosen; while the run asks about a planned path, the 3D view is large, unless another layout is chosen then. */
function useArrangement(hasView: boolean) {
  const [layout, choose] = useRunLayout(hasView)
  const asked = useLive((s) => proposedRequest(s.control, s.nodes, s.robots)?.path)
  const [declined, decline] = useState<string>()
  const isApproval = asked !== undefined && declined !== asked && hasView && layout !== '3d'
  const arrangement: Arrangement = isApproval ? 'approval' : layout
  function setLayout(next: RunLayout): void {
    decline(asked)
    choose(next)
  }
  return { layout, arrangement, setLayout }
}

/** Put the keyboard on the first button of an area; false where there is none. */
function focusFirst(id: string): boolean {
  const button = document.querySelector<HTMLElement>(`#${id} .mantine-Button-root`)
  button?.focus()
  return button !== null
}

function placeOf(session: SessionBody | undefined, active: readonly RunView[]): string {
  const where = session?.cell_name ? `It runs in the cell ${session.cell_name}, in real time.` : 'It runs without a cell, in real time.'
  const others = active.length === 1 ? 'Another run is' : `${active.length} other runs are`
  return active.length > 0 ? `${where} ${others} active: an arm that one of them holds is refused to this one.` : where
}

/** The page of a behavior: head, run control, graph, log, cell, parameters, outline and problems. */
import { Button } from '@mantine/core'
import { IconPencil, IconPlayerPlayFilled } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { loadSavedBreakpoints, toggleBreakpoint, useBreakpoints } from '../api/breakpoints'
import { api } from '../api/client'
import { useLive } from '../api/live'
import { useGoalsOf } from '../api/goals'
import { clearRefusal, showRefusal } from '../api/refusal'
import { hasCellView } from '../api/session'
import type { BehaviorView, RunView, SessionBody } from '../api/types'
import { Empty } from '../components/Empty'
import { OpenedTabs } from '../components/OpenedTabs'
import { Panel } from '../components/Panel'
import { StatusBadge } from '../components/StatusBadge'
import { ViewBoundary } from '../components/ViewBoundary'
import { isActive } from '../document/live'
import { nodeAt } from '../document/tree'
import { CellFrame } from '../features/cell/CellFrame'
import { ResetParts } from '../features/cell/ResetParts'
import { ShowMenu } from '../features/cell/ShowMenu'
import { ChangeReport } from '../features/control/ChangeReport'
import { Holds } from '../features/control/Holds'
import { FORCE_ID, NodeCard } from '../features/control/NodeCard'
import { RefusalLine } from '../features/control/RefusalLine'
import { Requests, REQUESTS_ID } from '../features/control/Requests'
import { RunBar } from '../features/control/RunBar'
import { ShortcutSheet } from '../features/control/ShortcutSheet'
import { useCommands, type Commands } from '../features/control/useCommands'
import { useShortcuts } from '../features/control/useShortcuts'
import { FindingList } from '../features/findings/FindingList'
import { Graph, type Shown } from '../features/graph/Graph'
import { Outline } from '../features/graph/Outline'
import { Selection } from '../features/graph/Selection'
import { Breadcrumb } from './Breadcrumb'
import { dockBodies } from './dock'
import { InterruptedHere } from './InterruptedHere'
import { FORM_ID, ParameterForm } from '../features/parameters/ParameterForm'
import { StartHereDialog } from '../features/parameters/StartHereDialog'
import { BlockedPaths } from '../features/robots/BlockedPaths'
import { RobotStrip } from '../features/robots/RobotStrip'
import { PastLine } from '../features/timeline/PastLine'
import { useFetched } from './useFetched'
import { NarrowGraph, SideTabs, Wide, type Tab } from './WorkSpace'

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
}

export function BehaviorPage(props: BehaviorPageProps) {
  const { id } = props
  const generation = useLive((s) => s.generation)
  // Whoever changed the behavior under way: what is drawn is what runs.
  const changedAt = useLive((s) => s.log.findLast((line) => line.kind === 'behavior_changed')?.seq ?? 0)
  const fetched = useFetched(id, () => api.behavior(id), changedAt)
  useEffect(() => {
    clearRefusal()
    void loadSavedBreakpoints(id)
  }, [id, generation])
  if (fetched.problem) return <Empty title="This behavior cannot be shown">{fetched.problem}</Empty>
  if (!fetched.value) return <div className="page-wait" role="status" aria-label="Loading" />
  return <Loaded {...props} behavior={fetched.value} />
}

function Loaded({ behavior, run, active, session, isNarrow, onStarted, onEdit }: BehaviorPageProps & { behavior: BehaviorView }) {
  const [selected, setSelected] = useState<string>()
  const [shown, setShown] = useState<Shown>()
  const [tab, setTab] = useState<Tab>(hasErrors(behavior) ? 'problems' : 'parameters')
  const [isSheetOpen, setSheetOpen] = useState(false)
  const isConnected = useLive((s) => s.connection === 'live')
  const obstacle = isConnected ? obstacleOf(behavior, active, session) : 'The server does not answer'
  const node = behavior.graph && selected ? nodeAt(behavior.graph, selected) : undefined
  const commands = useCommands(run, node?.path)
  const holds = useBreakpoints().length + useLive((s) => s.control?.locks.length ?? 0)
  const mayOperate = session?.role === 'operator'
  useGoalsOf(run && isActive(run) ? run.id : undefined)

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

  const keys = useShortcuts({
    pause: commands.pauseOrResume,
    into: () => commands.step('into'),
    over: () => commands.step('over'),
    out: () => commands.step('out'),
    back: commands.stepBack,
    stop: commands.stop,
    sheet: () => setSheetOpen(true),
    break: () => withNode('Breakpoint', 'breakpoint', (path) => void toggleBreakpoint(path)),
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

  function withNode(words: string, command: Parameters<Commands['obstacle']>[0], act: (path: string) => void): void {
    const why = commands.obstacle(command)
    if (why || !node) showRefusal(words, why ?? 'select a node in the graph first')
    else act(node.path)
  }

  const card = node && <NodeCard node={node} behavior={behavior.id} commands={commands} />
  const graph = behavior.graph ? (
    <Graph
      root={behavior.graph}
      selected={selected}
      onSelect={choose}
      shown={shown}
      behavior={behavior.id}
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
      className="cell-panel"
      tools={
        <>
          <span className="spacer" />
          {hasCellView(session) && <ShowMenu />}
          {mayOperate && <ResetParts isBusy={active.length > 0} />}
        </>
      }
      foot={<RobotStrip />}
    >
      <CellFrame />
    </Panel>
  )
  const parameters = (
    <div className="tab-body">
      <ParameterForm
        behavior={behavior}
        obstacle={obstacle}
        place={placeOf(session, active.filter((each) => each.behavior !== behavior.id))}
        terminal={`flexcell run ${behavior.id} --clock virtual`}
        onStarted={onStarted}
        run={run?.id}
      />
    </div>
  )
  const nodeTab = (
    <div className="tab-body is-flush">
      {node ? (
        <>
          {card}
          <Selection node={node} />
        </>
      ) : (
        <Empty title="No node is selected">Click a node in the graph, or select one in the outline.</Empty>
      )}
    </div>
  )
  const dock = dockBodies({ behavior, run, node: node?.path, session, onShow: show })
  const outline = (
    <div className="tab-body is-flush">
      {behavior.graph && <Outline root={behavior.graph} selected={selected} onSelect={setSelected} />}
      {node && <Selection node={node} />}
    </div>
  )
  const held = (
    <div className="tab-body">
      <Holds commands={commands} onShow={show} />
    </div>
  )
  const problems = (
    <div className="tab-body">
      <FindingList document={behavior.id} findings={behavior.findings} onSelect={show} />
    </div>
  )

  return (
    <div className="behavior-page">
      <header className="page-head">
        <div className="page-head-text">
          <h1>{behavior.name}</h1>
          {behavior.description && <p className="quiet">{behavior.description}</p>}
        </div>
        {run && <StatusBadge status={run.status} outcome={run.outcome} success={run.success} />}
        {run && !isActive(run) && run.cause && <span className="page-cause" title={run.cause}>{run.cause}</span>}
        <span className="spacer" />
        <Button variant="default" size="sm" leftSection={<IconPencil size={15} aria-hidden />} onClick={() => onEdit(selected ?? '')}>
          Edit
        </Button>
        <Button
          type="submit"
          form={FORM_ID}
          size="sm"
          leftSection={<IconPlayerPlayFilled size={14} aria-hidden />}
          disabled={obstacle !== undefined}
          title={obstacle}
        >
          Start
        </Button>
      </header>
      <ViewBoundary name="Interrupted run">
        <InterruptedHere behavior={behavior.name} onResumed={onStarted} />
      </ViewBoundary>
      <ViewBoundary name="Run control">
        <RunBar run={run} commands={commands} onSheet={() => setSheetOpen(true)} onShow={show} />
      </ViewBoundary>
      <ViewBoundary name="Timeline">
        <PastLine run={run} hasCellView={hasCellView(session)} />
      </ViewBoundary>
      <RefusalLine />
      <ViewBoundary name="Requests">
        <BlockedPaths />
        <Requests root={behavior.graph} commands={commands} onShow={show} />
      </ViewBoundary>
      {isNarrow ? (
        <OpenedTabs
          label="Views"
          className="narrow-tabs"
          bodies={{
            Start: parameters,
            Graph: <NarrowGraph graph={graph} card={card} />,
            Cell: cell,
            ...dock,
            Outline: outline,
            Breakpoints: held,
            Problems: problems,
          }}
        />
      ) : (
        <Wide
          graph={graph}
          log={<OpenedTabs label="Below the graph" bodies={dock} className="dock" />}
          cell={cell}
          tabs={
            <SideTabs
              tab={tab}
              onTab={setTab}
              counts={{ holds, problems: behavior.findings.length }}
              bodies={{ parameters, node: nodeTab, outline, holds: held, problems }}
            />
          }
        />
      )}
      <ChangeReport commands={commands} />
      <StartHereDialog behavior={behavior} obstacle={obstacle} onStarted={onStarted} />
      <ShortcutSheet isOpen={isSheetOpen} onClose={() => setSheetOpen(false)} areOn={keys.areOn} onSwitch={keys.setOn} />
    </div>
  )
}

/** Put the keyboard on the first button of an area; false where there is none. */
function focusFirst(id: string): boolean {
  const button = document.querySelector<HTMLElement>(`#${id} .command`)
  button?.focus()
  return button !== null
}

function hasErrors(behavior: BehaviorView): boolean {
  return behavior.findings.some((finding) => finding.severity === 'error')
}

function obstacleOf(behavior: BehaviorView, active: readonly RunView[], session: SessionBody | undefined): string | undefined {
  if (session && session.role !== 'operator') return 'You may look only: log in with the operator token to start runs'
  if (hasErrors(behavior)) return 'The document has errors; see its problems'
  if (behavior.fit.obstacle) return `It cannot be started here: ${behavior.fit.obstacle}`
  return active.some((run) => run.behavior === behavior.id) ? 'This behavior is running' : undefined
}

function placeOf(session: SessionBody | undefined, active: readonly RunView[]): string {
  const where = session?.cell_name ? `It runs in the cell ${session.cell_name}, in real time.` : 'It runs without a cell, in real time.'
  const others = active.length === 1 ? 'Another run is' : `${active.length} other runs are`
  return active.length > 0 ? `${where} ${others} active: an arm that one of them holds is refused to this one.` : where
}

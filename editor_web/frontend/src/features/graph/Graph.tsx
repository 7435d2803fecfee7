/** The live graph of a behavior: laid out once, lit by the run. */
import '@xyflow/react/dist/style.css'
import { ActionIcon, Box, Button, Group, Loader, Tooltip } from '@mantine/core'
import { useCallbackRef, useElementSize, useReducedMotion } from '@mantine/hooks'
import {
  IconArrowsMaximize,
  IconArrowsMoveVertical,
  IconArrowsRightDown,
  IconFocus2,
  IconFold,
  IconMinus,
  IconPlus,
} from '@tabler/icons-react'
import { Background, BackgroundVariant, Panel as Corner, ReactFlow, ReactFlowProvider, useReactFlow, useStore } from '@xyflow/react'
import { useCallback, useEffect, useMemo, useState, type MouseEvent, type ReactNode } from 'react'
import type { GraphNode } from '../../api/types'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { pathsTo } from '../../document/path'
import { ArrowHeads, CourseLine } from './CourseLine'
import { pointOf } from '../../components/menuPoint'
import type { Point, Size } from '../../document/geometry'
import type { Direction } from '../../document/branching'
import classes from './graph.module.css'
import { GraphMenu } from './GraphMenu'
import { canvasEdges, canvasNodes, type CanvasNode, type CourseEdge } from './elements'
import { LOW_DETAIL_ZOOM, LowDetailContext, LowDetailEdges, withLowDetail, LARGE_GRAPH_NODES } from './LowDetailGraph'
import { ContainerNode, DocumentContext, FoldContext, LeafNode, OutcomeNodeShell } from './StepShell'
import { useFolding, type Folding } from './useFolding'
import { useFollowView, useFollowing, type Following } from './useFollowing'
import { useLayout, type LaidOut } from './useLayout'

const NODE_TYPES = { leaf: withLowDetail(LeafNode), container: withLowDetail(ContainerNode), outcome: withLowDetail(OutcomeNodeShell) }
const EDGE_TYPES = { course: CourseLine }
const NO_EDGES: CourseEdge[] = []
/** Small graphs are not blown up beyond what is read well, more on screens of very high resolution. */
function fitOptions() {
  return { padding: 0.04, maxZoom: innerWidth > 2400 ? 1.9 : 1.2 }
}

export interface GraphProps {
  readonly root: GraphNode
  /** Path of the selected node. */
  readonly selected: string | undefined
  readonly onSelect: (path: string | undefined) => void
  /** A node to bring into view; a new object asks anew. */
  readonly shown: Shown | undefined
  /** Shown in the head of the panel. */
  readonly breadcrumb: ReactNode
  /** The behavior whose runs are started from here; the graph has no menus without. */
  readonly behavior?: string
  /** What the menu of a node shows for its breakpoints. */
  readonly breakpointForm?: (path: string) => ReactNode
  /** The behavior whose nodes others may have selected; theirs are not shown without. */
  readonly document?: string
  /** Whose graph it is, where there are several. */
  readonly of?: string
}

/** Which node was asked for. */
export interface Shown {
  readonly path: string
}

export function Graph(props: GraphProps) {
  return (
    <ReactFlowProvider>
      <Canvas {...props} />
    </ReactFlowProvider>
  )
}

function Canvas({ root, selected, onSelect, shown, breadcrumb, behavior, breakpointForm, document = '', of }: GraphProps) {
  const { ref, width, height } = useElementSize()
  const [flow, setFlow] = useState<Direction>('RIGHT')
  const pane = width > 0 && height > 0 ? { width, height } : undefined
  const following = useFollowing(root)
  const fold = useFolding(root, shown, following.isOn ? following.targets : '')
  const { laidOut, problem } = useLayout(fold.drawn, root, flow)
  const detail = useStore((s) => detailAt(s.transform[2]))
  const turned = flow === 'RIGHT' ? 'DOWN' : 'RIGHT'
  /** To collapse what is followed is to look at something else. */
  const toggle = useCallbackRef((path: string) => {
    if (following.targets.split('\n').some((each) => pathsTo(each).includes(path))) following.pause()
    fold.toggle(path)
  })
  return (
    <Panel
      title="Graph"
      of={of}
      tools={
        <>
          {breadcrumb}
          <Box flex={1} />
          <CanvasTools onTurn={() => setFlow(turned)} following={following} fold={fold} />
        </>
      }
    >
      <div className={classes.graph} data-graph data-detail={detail} ref={ref}>
        <ArrowHeads />
        {problem && <Empty title="The graph could not be laid out">{problem}</Empty>}
        {!laidOut && !problem && (
          <Group justify="center" gap="xs" h="100%" c="var(--quiet)" role="status">
            <Loader size="sm" aria-hidden />
            <span>Drawing…</span>
          </Group>
        )}
        {laidOut && pane && (
          <DocumentContext value={document}>
            <FoldContext value={toggle}>
              <Drawn
                laidOut={laidOut}
                pane={pane}
                selected={selected}
                onSelect={onSelect}
                shown={shown}
                following={following}
                {...(behavior === undefined ? {} : { behavior })}
                {...(breakpointForm && { breakpointForm })}
              />
            </FoldContext>
          </DocumentContext>
        )}
      </div>
    </Panel>
  )
}

interface DrawnProps extends Omit<GraphProps, 'root' | 'breadcrumb' | 'document' | 'of'> {
  readonly laidOut: LaidOut
  readonly pane: Size
  readonly following: Following
}

function Drawn({ laidOut, pane, selected, onSelect, shown, following, behavior, breakpointForm }: DrawnProps) {
  const [menu, setMenu] = useState<{ readonly node: GraphNode; readonly at: Point }>()
  const { fitView } = useReactFlow()
  const isStill = useReducedMotion() ?? false
  const showAll = useCallback(() => void fitView(fitOptions()), [fitView])
  const onMoved = useFollowView(laidOut, pane, following, showAll)
  const drawn = useMemo(() => canvasNodes(laidOut), [laidOut])
  const edges = useMemo(() => canvasEdges(laidOut), [laidOut])
  const nodes = useMemo<CanvasNode[]>(
    () => drawn.map((node) => (node.id === selected ? { ...node, selected: true } : node)),
    [drawn, selected],
  )

  const hasMany = drawn.length > LARGE_GRAPH_NODES
  const isFar = useStore((s) => s.transform[2] < LOW_DETAIL_ZOOM) && hasMany

  useEffect(() => {
    if (!shown) return
    onMoved()
    void fitView({ nodes: [{ id: shown.path }], padding: 0.6, maxZoom: 1, duration: isStill ? 0 : 300 })
  }, [shown, fitView, onMoved, isStill])

  const onNodeClick = useCallback((_: unknown, node: CanvasNode) => onSelect(node.type === 'outcome' ? undefined : node.id), [onSelect])

  const onNodeMenu = useCallback(
    (event: MouseEvent, node: CanvasNode) => {
      if (behavior === undefined || node.type === 'outcome') return
      event.preventDefault()
      onSelect(node.id)
      setMenu({ node: node.data.node, at: pointOf(event) })
    },
    [behavior, onSelect],
  )

  return (
    <LowDetailContext value={isFar}>
      {behavior !== undefined && menu && (
        <GraphMenu
          behavior={behavior}
          node={menu.node}
          breakpointForm={breakpointForm?.(menu.node.path)}
          at={menu.at}
          onClose={() => setMenu(undefined)}
        />
      )}
      <ReactFlow
        nodes={nodes}
        edges={isFar ? NO_EDGES : edges}
        onlyRenderVisibleElements={hasMany && !isFar}
        nodeTypes={NODE_TYPES}
        edgeTypes={EDGE_TYPES}
        onNodeClick={onNodeClick}
        onNodeContextMenu={onNodeMenu}
        onPaneClick={() => onSelect(undefined)}
        // Without an event it is the page that moves it.
        onMoveStart={(event) => event && onMoved()}
        onNodesChange={(changes) => {
          const chosen = changes.find((change) => change.type === 'select' && change.selected)
          if (chosen && 'id' in chosen) onSelect(chosen.id)
        }}
        nodesDraggable={false}
        nodesConnectable={false}
        edgesFocusable={false}
        deleteKeyCode={null}
        minZoom={0.03}
        maxZoom={3}
        fitView
        fitViewOptions={fitOptions()}
        proOptions={{ hideAttribution: false }}
        aria-label="Graph of the behavior"
      >
        <Background variant={BackgroundVariant.Dots} gap={20} size={1.2} />
        {!following.isOn && following.targets !== '' && (
          <Corner position="bottom-center">
            <Button size="xs" leftSection={<IconFocus2 size={15} aria-hidden />} onClick={following.resume}>
              Follow
            </Button>
          </Corner>
        )}
        {isFar && <LowDetailEdges courses={laidOut.layout.courses} />}
      </ReactFlow>
    </LowDetailContext>
  )
}

/** What can be read at a zoom: everything, names only, or names that are the larger. */
function detailAt(zoom: number): 'all' | 'names' | 'far' {
  if (zoom >= 0.62) return 'all'
  return zoom >= 0.4 ? 'names' : 'far'
}

interface CanvasToolsProps {
  readonly onTurn: () => void
  readonly following: Following
  readonly fold: Folding
}

function CanvasTools({ onTurn, following, fold }: CanvasToolsProps) {
  const { fitView, zoomIn, zoomOut } = useReactFlow()
  /** What is asked for here is not taken back by the run. */
  const byHand = (move: () => unknown) => () => {
    if (following.targets !== '') following.pause()
    move()
  }
  return (
    <Group gap={2} wrap="nowrap">
      <Tool label="Follow the active nodes" onClick={following.isOn ? following.pause : following.resume} pressed={following.isOn}>
        <IconFocus2 size={16} />
      </Tool>
      <Tool label="Collapse what is not active" onClick={fold.toggleInactive} pressed={fold.hidesInactive}>
        <IconFold size={16} />
      </Tool>
      {fold.hasFolded && (
        <Tool label="Expand all" onClick={fold.expandAll}>
          <IconArrowsMoveVertical size={16} />
        </Tool>
      )}
      <Tool label="Zoom in" onClick={byHand(() => zoomIn({ duration: 150 }))}>
        <IconPlus size={16} />
      </Tool>
      <Tool label="Zoom out" onClick={byHand(() => zoomOut({ duration: 150 }))}>
        <IconMinus size={16} />
      </Tool>
      <Tool label="Show all" onClick={byHand(() => fitView({ ...fitOptions(), duration: 200 }))}>
        <IconArrowsMaximize size={16} />
      </Tool>
      <Tool label="Turn the direction of the flow" onClick={onTurn}>
        <IconArrowsRightDown size={16} />
      </Tool>
    </Group>
  )
}

interface ToolProps {
  readonly label: string
  readonly onClick: () => void
  /** Given for what is switched on and off. */
  readonly pressed?: boolean
  readonly children: ReactNode
}

function Tool({ label, onClick, pressed, children }: ToolProps) {
  return (
    <Tooltip label={label} openDelay={300}>
      <ActionIcon
        variant={pressed ? 'light' : 'subtle'}
        color={pressed ? 'accent' : 'gray'}
        size="md"
        aria-label={label}
        {...(pressed === undefined ? {} : { 'aria-pressed': pressed })}
        onClick={onClick}
      >
        {children}
      </ActionIcon>
    </Tooltip>
  )
}

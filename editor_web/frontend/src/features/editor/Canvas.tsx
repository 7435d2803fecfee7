/** The canvas: what is drawn on it; what can be done with it is in a hook for each subject. */
import '@xyflow/react/dist/style.css'
import { useElementSize } from '@mantine/hooks'
import { Background, BackgroundVariant, ConnectionMode, MiniMap, ReactFlow, SelectionMode, useReactFlow } from '@xyflow/react'
import { useEffect, useRef, useState } from 'react'
import { Empty } from '../../components/Empty'
import type { Size } from '../../document/geometry'
import classes from './canvas.module.css'
import {
  isAllowed,
  onConnect,
  onDouble,
  onEdgeClick,
  onNodeClick,
  onNodeMenu,
  onPaneClick,
  onReconnect,
  onSelectionMenu,
} from './canvasHandlers'
import { EmptyCanvas } from './EmptyCanvas'
import { BranchLine, EditArrowHeads, TransitionLine } from './Lines'
import { LowDetailEdges, withLowDetail } from './LowDetail'
import { FrameCard, LeafCard, PillCard, RulesCard, TwigCard } from './Cards'
import type { CanvasEdge, CanvasNode } from './elements'
import { LEAST } from './viewport'
import { FlowOverlay } from './FlowOverlay'
import { NodeMenu } from './NodeMenu'
import { FreeNoteOverlay } from './FreeNoteOverlay'
import { NoteOverlay } from './NoteOverlay'
import { SelectionBar } from './SelectionBar'
import { useEditor } from './store'
import { useArrangement, useIsBusy, type Arranged } from './useArrangement'
import { useCanvasConnect } from './useCanvasConnect'
import { useCanvasDrag } from './useCanvasDrag'
import { useCanvasDrop } from './useCanvasDrop'
import { useCanvasEdges } from './useCanvasEdges'
import { useCanvasNodes } from './useCanvasNodes'
import { useCanvasViewport, useLevelOfDetail } from './useCanvasViewport'
import { useFrameDrag } from './useFrameDrag'
import { useShownNode } from './useShownNode'

const NODE_TYPES = {
  leaf: withLowDetail(LeafCard),
  frame: withLowDetail(FrameCard),
  twig: withLowDetail(TwigCard),
  pill: withLowDetail(PillCard),
  rules: withLowDetail(RulesCard),
}
const NO_EDGES: CanvasEdge[] = []
const EDGE_TYPES = { transition: TransitionLine, branch: BranchLine }
const SELECT_KEYS = ['Shift', 'Meta', 'Control']

// Elements of their own: a node that is dragged draws the canvas with each frame, and these stay as they are.
const DOTS = <Background variant={BackgroundVariant.Dots} gap={20} size={1.2} />
const MAP = (
  <MiniMap
    pannable
    zoomable
    style={{ border: '1px solid var(--line)' }}
    ariaLabel="Overview of the canvas"
    nodeColor={({ type }) => (type === 'frame' ? 'none' : 'var(--line-strong)')}
    nodeStrokeColor={({ type }) => (type === 'frame' ? 'var(--line-strong)' : 'none')}
    nodeStrokeWidth={6}
  />
)
const OVERLAYS = (
  <>
    <FlowOverlay />
    <FreeNoteOverlay />
    <NoteOverlay />
    <SelectionBar />
    <NodeMenu />
  </>
)

export function Canvas({ hasMap, boxSelects }: { hasMap: boolean; boxSelects: boolean }) {
  const { ref, width, height } = useElementSize()
  const pane = width > 0 && height > 0 ? { width, height } : undefined
  const { arranged, problem } = useArrangement()
  const [drawn, setDrawn] = useState<Arranged>()
  const isBusy = useIsBusy(drawn)
  return (
    <div className={classes['canvas']} ref={ref} data-canvas aria-busy={isBusy} data-drawn={drawn?.arrangement.boxes.size}>
      <EditArrowHeads />
      {problem && <Empty title="The graph could not be laid out">{problem}</Empty>}
      {arranged && pane && <Drawn arranged={arranged} pane={pane} hasMap={hasMap} boxSelects={boxSelects} onDrawn={setDrawn} />}
    </div>
  )
}

interface DrawnProps {
  readonly arranged: Arranged
  readonly pane: Size
  readonly hasMap: boolean
  readonly boxSelects: boolean
  /** This is on the canvas, with each node in its place. */
  readonly onDrawn: (drawn: Arranged) => void
}

function Drawn({ arranged, pane, hasMap, boxSelects, onDrawn }: DrawnProps) {
  const { getInternalNode } = useReactFlow<CanvasNode, CanvasEdge>()
  const isStale = useEditor((s) => s.history.steps[s.history.at]?.draft.isStale ?? false)
  const element = useRef<HTMLDivElement>(null)
  const drawn = useCanvasNodes(arranged)
  const { computed, given, onNodesChange, putBack } = drawn
  const edges = useCanvasEdges(arranged)
  const canvas = { arranged, computed, getInternalNode }
  const { hasMany, isFar } = useLevelOfDetail(arranged.scope.path, computed.length)
  const { isInPlace, onMoveStart } = useCanvasViewport(arranged, pane)
  const frameDrag = useFrameDrag(element, drawn.nodes, !hasMany)
  const drag = useCanvasDrag(canvas, putBack, frameDrag)
  const { isConnecting, onConnectStart, onConnectEnd } = useCanvasConnect(canvas)
  const { onDragOver, onDrop, onPaneContextMenu } = useCanvasDrop(canvas)
  useShownNode(element, arranged, drawn)
  // React Flow moves its nodes a turn after they were given to it.
  useEffect(() => given && onDrawn(given), [given, onDrawn])

  return (
    <ReactFlow<CanvasNode, CanvasEdge>
      ref={element}
      className={classes['flow'] ?? ''}
      data-in-place={isInPlace || undefined}
      data-connecting={isConnecting || undefined}
      data-stale={isStale || undefined}
      nodes={frameDrag.nodes}
      edges={isFar ? NO_EDGES : (edges as CanvasEdge[])}
      onlyRenderVisibleElements={hasMany && !isFar}
      nodeTypes={NODE_TYPES}
      edgeTypes={EDGE_TYPES}
      onNodesChange={onNodesChange}
      onEdgeClick={onEdgeClick}
      onNodeClick={onNodeClick}
      onNodeDoubleClick={onDouble}
      onNodeContextMenu={onNodeMenu}
      onSelectionContextMenu={onSelectionMenu}
      onPaneClick={onPaneClick}
      {...drag}
      onMoveStart={onMoveStart}
      onConnectStart={onConnectStart}
      onConnect={onConnect}
      onConnectEnd={onConnectEnd}
      isValidConnection={isAllowed}
      onReconnect={onReconnect}
      onPaneContextMenu={onPaneContextMenu}
      onDragOver={onDragOver}
      onDrop={onDrop}
      connectionMode={ConnectionMode.Strict}
      connectionRadius={26}
      reconnectRadius={8}
      selectionMode={SelectionMode.Partial}
      selectionOnDrag={boxSelects}
      panOnDrag={boxSelects ? [1, 2] : true}
      multiSelectionKeyCode={SELECT_KEYS}
      deleteKeyCode={null}
      disableKeyboardA11y
      edgesFocusable={false}
      elevateNodesOnSelect={false}
      nodeDragThreshold={4}
      zoomOnDoubleClick={false}
      minZoom={LEAST}
      maxZoom={2.5}
      aria-label="Canvas of the behavior"
    >
      {DOTS}
      {hasMap && MAP}
      {isFar && <LowDetailEdges nodes={computed} edges={edges} />}
      {OVERLAYS}
      {arranged.scope.children.length === 0 && <EmptyCanvas />}
    </ReactFlow>
  )
}

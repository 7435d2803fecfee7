/** The canvas: what is drawn, what dragging, dropping and connecting on it mean. */
import '@xyflow/react/dist/style.css'
import { useCallbackRef, useElementSize } from '@mantine/hooks'
import {
  applyNodeChanges,
  Background,
  BackgroundVariant,
  ConnectionMode,
  MiniMap,
  ReactFlow,
  SelectionMode,
  useReactFlow,
  useStore,
  type FinalConnectionState,
  type NodeChange,
} from '@xyflow/react'
import { useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState, type DragEvent } from 'react'
import { Empty } from '../../components/Empty'
import { isForeign, isHolder, isMachine, nodeOf, parentPath } from '../../document/editing/model'
import { frameOf } from '../../document/editing/expansion'
import type { Point } from '../../document/geometry'
import { add, choose, chooseArrow, moveInto, type Addition } from './actions'
import { place } from './placing'
import { openAddPalette, openPortPalette } from './paletteRequests'
import { isAllowed, onConnect, onDouble, onEdgeClick, onNodeClick, onNodeMenu, onReconnect, onSelectionMenu } from './canvasHandlers'
import classes from './canvas.module.css'
import { setCanvasPositions } from './canvasPositions'
import { drawInBatches } from './batchedDrawing'
import { EmptyCanvas } from './EmptyCanvas'
import { BranchLine, EditArrowHeads, TransitionLine } from './Lines'
import { LOW_DETAIL_ZOOM, LowDetailEdges, withLowDetail, LARGE_GRAPH_NODES, setLowDetail } from './LowDetail'
import { FrameCard, LeafCard, PillCard, RulesCard, TwigCard } from './Cards'
import { canvasEdges, canvasNodes, type CanvasEdge, type CanvasNode } from './elements'
import { ADDITION } from './dragging'
import { trackMotionNextFrame } from './viewportMotion'
import { isAllSeen, LEAST, viewportFor } from './viewport'
import { FlowOverlay } from './FlowOverlay'
import { NodeMenu } from './NodeMenu'
import { NoteOverlay } from './NoteOverlay'
import { SelectionBar } from './SelectionBar'
import { editor, showEditorRefusal, rootOf, setEditor, useEditor } from './store'
import { useArrangement, useIsBusy, type Arranged } from './useArrangement'
import { useStableList } from './useStableList'

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

export function Canvas({ hasMap, boxSelects }: { hasMap: boolean; boxSelects: boolean }) {
  const { ref, width, height } = useElementSize()
  const pane = width > 0 && height > 0 ? { width, height } : undefined
  const { arranged, problem } = useArrangement(pane)
  const [drawn, setDrawn] = useState<Arranged>()
  const isBusy = useIsBusy(drawn)
  return (
    <div className={classes['canvas']} ref={ref} data-canvas aria-busy={isBusy} data-drawn={drawn?.arrangement.boxes.size}>
      <EditArrowHeads />
      {problem && <Empty title="The graph could not be laid out">{problem}</Empty>}
      {arranged && <Drawn arranged={arranged} pane={`${width}x${height}`} hasMap={hasMap} boxSelects={boxSelects} onDrawn={setDrawn} />}
    </div>
  )
}

interface DrawnProps {
  readonly arranged: Arranged
  readonly pane: string
  readonly hasMap: boolean
  readonly boxSelects: boolean
  /** This is on the canvas, with each node in its place. */
  readonly onDrawn: (drawn: Arranged) => void
}

function Drawn({ arranged, pane, hasMap, boxSelects, onDrawn }: DrawnProps) {
  const { fitView, getViewport, setViewport, screenToFlowPosition, getInternalNode, getZoom } = useReactFlow<CanvasNode, CanvasEdge>()
  const selection = useEditor((s) => s.selection)
  const arrow = useEditor((s) => s.arrow)
  const shown = useEditor((s) => s.shown)
  const isStale = useEditor((s) => s.history.steps[s.history.at]?.draft.isStale ?? false)
  const computed = useStableList(useMemo(() => canvasNodes(arranged), [arranged]))
  const [nodes, setNodes] = useState<CanvasNode[]>([...computed])
  const [given, setGiven] = useState<Arranged>()
  const [isConnecting, setConnecting] = useState(false)
  const [isInPlace, setInPlace] = useState(false)
  const [lookedFor, setLookedFor] = useState<typeof shown>()
  const element = useRef<HTMLDivElement>(null)
  const handled = useRef<typeof shown>(undefined)
  const isFitted = useRef(false)

  useEffect(() => {
    setCanvasPositions(arranged.arrangement)
    const chosen = new Set(selection)
    const all = computed.map((node) => (chosen.has(node.id) ? { ...node, selected: true } : node))
    const isThere = (id: string) => getInternalNode(id) !== undefined
    return drawInBatches(all, { isThere, give: setNodes, done: () => setGiven(arranged) })
  }, [arranged, computed, selection, getInternalNode])
  // React Flow moves its nodes a turn after they were given to it.
  useEffect(() => given && onDrawn(given), [given, onDrawn])

  const edges = useStableList(
    useMemo(
      () => canvasEdges(arranged, selection).map((edge) => (edge.id === arrow ? { ...edge, selected: true } : edge)),
      [arranged, selection, arrow],
    ),
  )

  const hasMany = computed.length > LARGE_GRAPH_NODES
  const isFar = useStore((s) => s.transform[2] < LOW_DETAIL_ZOOM) && hasMany
  useLayoutEffect(() => setLowDetail(isFar ? arranged.scope.path : undefined), [isFar, arranged.scope.path])
  useEffect(() => () => setLowDetail(undefined), [])

  useEffect(() => {
    return trackMotionNextFrame(() => {
      const [width = 0, height = 0] = pane.split('x').map(Number)
      isFitted.current = true
      return setViewport(viewportFor(arranged.arrangement, { width, height })).then(() => setInPlace(true))
    })
    // oxlint-disable-next-line react/exhaustive-deps -- what is edited does not move the view
  }, [arranged.view, pane, setViewport])

  // What an edit pushes out of sight is brought back, unless somebody has chosen what to see.
  useEffect(() => {
    const [width = 0, height = 0] = pane.split('x').map(Number)
    if (isFitted.current && !isAllSeen(arranged.arrangement, getViewport(), { width, height })) {
      void setViewport(viewportFor(arranged.arrangement, { width, height }))
    }
    // oxlint-disable-next-line react/exhaustive-deps -- a change of the pane has its own effect
  }, [arranged, getViewport, setViewport])

  // A node asked for is brought into view where it is not, and gets the keyboard.
  useEffect(() => {
    if (!shown || handled.current === shown) return
    const { scope } = editor()
    const isCurrent = arranged.root === rootOf(editor()) && arranged.view === scope
    if (isCurrent && shown.path !== scope && nodeOf(arranged.root, shown.path) && !computed.some((node) => node.id === shown.path)) {
      // It is inside a container that is closed here: go there.
      setEditor({ scope: parentPath(shown.path) })
      return
    }
    if (given !== arranged) return
    return trackMotionNextFrame(() => {
      const target = element.current?.querySelector<HTMLElement>(`.react-flow__node[data-id="${CSS.escape(shown.path)}"]`)
      if (!target) {
        // Of many, only those in view are drawn: go there first.
        if (!computed.some((node) => node.id === shown.path)) return undefined
        return fitView({ nodes: [{ id: shown.path }], padding: 0.9, maxZoom: 1 }).then(() => setLookedFor(shown))
      }
      handled.current = shown
      const around = element.current?.getBoundingClientRect()
      const own = target.getBoundingClientRect()
      const isInView =
        around && own.left >= around.left && own.right <= around.right && own.top >= around.top && own.bottom <= around.bottom
      if (!document.activeElement || document.activeElement === document.body || element.current?.contains(document.activeElement))
        target.focus({ preventScroll: true })
      if (isInView && getZoom() >= 0.4) return undefined
      return fitView({ nodes: [{ id: shown.path }], padding: 0.9, maxZoom: 1, duration: 200 })
    })
  }, [shown, computed, arranged, given, fitView, getZoom, lookedFor])

  const onNodesChange = useCallback((changes: NodeChange<CanvasNode>[]) => {
    const picks = changes.filter((change) => change.type === 'select')
    if (picks.length > 0) {
      const now = new Set(editor().selection)
      for (const pick of picks) {
        if (pick.selected) now.add(pick.id)
        else now.delete(pick.id)
      }
      choose([...now])
    }
    const others = changes.filter((change) => change.type !== 'select')
    if (others.length > 0) setNodes((before) => applyNodeChanges(others, before))
  }, [])

  // What is given to React Flow stays the same function: all it draws is looked through for each new one.
  const onDragStop = useCallbackRef((_event: unknown, _node: CanvasNode, dragged: CanvasNode[]): void => {
    const root = rootOf(editor())
    const moved = dragged.filter((node) => node.type !== 'pill' && node.type !== 'rules')
    if (!root || moved.length === 0) return
    const target = holderUnder(moved)
    if (target) {
      void moveInto(
        moved.map((node) => node.id),
        target,
        new Map(moved.flatMap((node) => (absolute(node.id) ? [[node.id, positionIn(target, absolute(node.id) ?? node.position)]] : []))),
      )
      setNodes([...computed])
      return
    }
    const changed = moved.filter((node) => {
      const before = arranged.arrangement.boxes.get(node.id)
      return before && (Math.abs(before.x - node.position.x) > 2 || Math.abs(before.y - node.position.y) > 2)
    })
    const free = changed.filter((node) => isMachine(nodeOf(root, parentPath(node.id))?.kind ?? ''))
    if (free.length > 0)
      void place(new Map(free.map((node) => [node.id, node.position]))).then((isThere) => {
        if (!isThere) setNodes([...computed])
      })
    if (free.length < changed.length) setNodes([...computed])
  })

  const onSelectionDragStop = useCallbackRef((event: unknown, moved: CanvasNode[]) => onDragStop(event, moved[0] as CanvasNode, moved))
  const onConnectStart = useCallbackRef(() => setConnecting(true))
  const onMoveStart = useCallbackRef((event: unknown) => {
    if (event) isFitted.current = false
  })

  /** The container under the middle of what was dragged, where it is another one than before. */
  function holderUnder(moved: readonly CanvasNode[]): string | undefined {
    const first = moved[0]
    const box = first && absolute(first.id)
    if (!first || !box) return undefined
    const middle = { x: box.x + box.width / 2, y: box.y + 20 }
    const at = frameAt(middle, (path) => moved.some((node) => path === node.id || path.startsWith(`${node.id}/`)))
    const root = rootOf(editor())
    const now = root && frameOf(arranged.scope, first.id).path
    if (!root || at === now || isForeign(root, `${at}/x`)) return undefined
    const holder = nodeOf(root, at)
    return holder && isHolder(holder) ? at : undefined
  }

  function absolute(id: string): { x: number; y: number; width: number; height: number } | undefined {
    const node = getInternalNode(id)
    if (!node) return undefined
    return { ...node.internals.positionAbsolute, width: node.width ?? 0, height: node.height ?? 0 }
  }

  /** The innermost open container at a place; the one that fills the canvas where there is none. */
  function frameAt(at: Point, isLeftOut: (path: string) => boolean = () => false): string {
    const hits = computed
      .filter((node) => node.type === 'frame' && !isLeftOut(node.id))
      .filter((node) => {
        const box = absolute(node.id)
        return box && at.x >= box.x && at.x <= box.x + box.width && at.y >= box.y && at.y <= box.y + box.height
      })
      .map((node) => node.id)
    return hits.toSorted((a, b) => b.length - a.length)[0] ?? arranged.scope.path
  }

  /** A place of the canvas as a position in a container. */
  function positionIn(path: string, at: Point): Point {
    const box = path === arranged.scope.path ? { x: 0, y: 0 } : absolute(path)
    const origin = arranged.arrangement.origins.get(path) ?? { x: 0, y: 0 }
    return { x: at.x - (box?.x ?? 0) - origin.x, y: at.y - (box?.y ?? 0) - origin.y }
  }

  const onConnectEnd = useCallbackRef((event: MouseEvent | TouchEvent, state: FinalConnectionState): void => {
    setConnecting(false)
    if (state.isValid || !state.fromNode || !state.fromHandle?.id || state.fromHandle.type !== 'source') return
    const point = 'changedTouches' in event ? event.changedTouches[0] : event
    if (!point) return
    const screen = { x: point.clientX, y: point.clientY }
    openPortPalette(state.fromNode.id, state.fromHandle.id, screen, positionIn(parentPath(state.fromNode.id), screenToFlowPosition(screen)))
  })

  function onDrop(event: DragEvent): void {
    const dragged = event.dataTransfer.getData(ADDITION)
    if (!dragged) return
    event.preventDefault()
    const what = JSON.parse(dragged) as Addition
    const screen = { x: event.clientX, y: event.clientY }
    const hit = document.elementsFromPoint(screen.x, screen.y).find((each) => each.classList.contains('react-flow__edge-interaction'))
    const edge = hit?.closest('.react-flow__edge')?.getAttribute('data-id')?.split('|')
    if (edge?.length === 3) {
      const [machine = '', source = '', outcome = ''] = edge
      void add(what, { parent: machine, from: { path: `${machine}/${source}`, outcome, isInsert: true } })
      return
    }
    const at = screenToFlowPosition(screen)
    const parent = dropHolder(frameAt(at), screen)
    if (parent) void add(what, { parent, at: positionIn(parent, at) })
    else showEditorRefusal('Add', 'nothing can be put in here', 'Drop it on a container or a free place.')
  }

  /** What takes a dropped addition: the branch of a tree under the pointer, else the container around. */
  function dropHolder(frame: string, screen: Point): string | undefined {
    const root = rootOf(editor())
    if (!root) return undefined
    const under = document
      .elementsFromPoint(screen.x, screen.y)
      .map((each) => each.closest('.react-flow__node')?.getAttribute('data-id') ?? '')
    const twig = under.map((id) => nodeOf(root, id)).find((node) => node && isHolder(node) && node.path.startsWith(frame))
    const holder = twig ?? nodeOf(root, frame)
    if (!holder || isForeign(root, `${holder.path}/x`)) return undefined
    if (isHolder(holder)) return holder.path
    const top = holder.kind === 'tree' ? holder.children[0] : undefined
    return top && isHolder(top) ? top.path : undefined
  }

  return (
    <ReactFlow<CanvasNode, CanvasEdge>
      ref={element}
      className={classes['flow'] ?? ''}
      data-in-place={isInPlace || undefined}
      data-connecting={isConnecting || undefined}
      data-stale={isStale || undefined}
      nodes={nodes}
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
      onPaneClick={() => {
        choose([])
        chooseArrow(undefined)
      }}
      onNodeDragStop={onDragStop}
      onSelectionDragStop={onSelectionDragStop}
      onMoveStart={onMoveStart}
      onConnectStart={onConnectStart}
      onConnect={onConnect}
      onConnectEnd={onConnectEnd}
      isValidConnection={isAllowed}
      onReconnect={onReconnect}
      onPaneContextMenu={(event) => {
        event.preventDefault()
        const screen = { x: event.clientX, y: event.clientY }
        const at = screenToFlowPosition(screen)
        choose([])
        setEditor({ palette: undefined })
        openAddPalette(screen, positionIn(arranged.scope.path, at))
      }}
      onDragOver={(event) => {
        if (!event.dataTransfer.types.includes(ADDITION)) return
        event.preventDefault()
        event.dataTransfer.dropEffect = 'copy'
      }}
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
      <Background variant={BackgroundVariant.Dots} gap={20} size={1.2} />
      {hasMap && (
        <MiniMap
          pannable
          zoomable
          style={{ border: '1px solid var(--line)' }}
          ariaLabel="Overview of the canvas"
          nodeColor={({ type }) => (type === 'frame' ? 'none' : 'var(--line-strong)')}
          nodeStrokeColor={({ type }) => (type === 'frame' ? 'var(--line-strong)' : 'none')}
          nodeStrokeWidth={6}
        />
      )}
      {isFar && <LowDetailEdges nodes={computed} edges={edges} />}
      <FlowOverlay />
      <NoteOverlay />
      <SelectionBar />
      <NodeMenu />
      {arranged.scope.children.length === 0 && <EmptyCanvas />}
    </ReactFlow>
  )
}

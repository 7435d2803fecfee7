/** The canvas from far away: plain boxes, and all arrows as one line, for behaviors of a thousand nodes. */
import { ViewportPortal, type NodeProps } from '@xyflow/react'
import { memo, useMemo, type ComponentType } from 'react'
import type { Box, Point } from '../../document/geometry'
import { parentPath } from '../../document/path'
import classes from './cards.module.css'
import type { CanvasEdge, CanvasNode, CardData } from './elements'
import { useMark } from './marks'
import { pageStore } from '../../api/pageStore'

/** More nodes than this are drawn in full only where they are seen. */
export const LARGE_GRAPH_NODES = 300
/** Below this zoom nothing that is written on a node can be read. */
export const LOW_DETAIL_ZOOM = 0.35

const useFar = pageStore<{ readonly scope: string | undefined }>(() => ({ scope: undefined }))

/** Draw plain boxes from now on, of what is inside `scope`; everything in full with undefined. */
export function setLowDetail(scope: string | undefined): void {
  useFar.setState({ scope })
}

/** A kind of node that is a plain box when seen from far away. */
export function withLowDetail<P extends NodeProps<CanvasNode>>(Near: ComponentType<P>): ComponentType<P> {
  return memo(function Levelled(props: P) {
    const isFar = useFar((s) => s.scope !== undefined)
    return isFar ? <PlainBox {...props} /> : <Near {...props} />
  }, looksAlike)
}

interface Looks {
  readonly id: string
  readonly type: string
  readonly data: unknown
  readonly selected: boolean
  readonly width?: number | undefined
  readonly height?: number | undefined
}

const LOOKS = ['id', 'type', 'data', 'selected', 'width', 'height'] as const

/** Where a node stands is not drawn by itself: what moves with its container stays as it is. */
function looksAlike(a: Looks, b: Looks): boolean {
  return LOOKS.every((name) => a[name] === b[name])
}

function PlainBox(props: NodeProps<CanvasNode>) {
  const { id, type, selected, width = 0, height = 0 } = props
  const mark = useMark(id, type === 'leaf')
  const isOuter = useFar((s) => s.scope === parentPath(id))
  const name = type === 'frame' ? (props.data as CardData).node.name : ''
  const size = Math.min(170, (width * 1.5) / Math.max(6, name.length), height / 2)
  return (
    <div className={classes['box']} data-box={type} data-selected={selected || undefined} data-severity={mark?.severity}>
      {isOuter && type === 'frame' && (
        <span className={classes['farName']} style={{ fontSize: size }}>
          {name}
        </span>
      )}
    </div>
  )
}

export interface LowDetailEdgesProps {
  readonly nodes: readonly CanvasNode[]
  readonly edges: readonly CanvasEdge[]
}

const OVER = { position: 'absolute', top: 0, left: 0, overflow: 'visible', pointerEvents: 'none' } as const

/** Every arrow and branch in one path. */
export const LowDetailEdges = memo(function FarLines({ nodes, edges }: LowDetailEdgesProps) {
  const path = useMemo(() => linesOf(nodes, edges), [nodes, edges])
  return (
    <ViewportPortal>
      <svg style={OVER} data-far-lines aria-hidden>
        <path d={path} fill="none" stroke="var(--edge)" strokeWidth={5} />
      </svg>
    </ViewportPortal>
  )
})

function linesOf(nodes: readonly CanvasNode[], edges: readonly CanvasEdge[]): string {
  const boxes = new Map<string, Box>()
  for (const { id, parentId, position, width = 0, height = 0 } of nodes) {
    const frame = parentId === undefined ? undefined : boxes.get(parentId)
    boxes.set(id, { x: position.x + (frame?.x ?? 0), y: position.y + (frame?.y ?? 0), width, height })
  }
  return edges.map((edge) => lineOf(edge, boxes)).join('')
}

function lineOf(edge: CanvasEdge, boxes: ReadonlyMap<string, Box>): string {
  const [from, to] = [boxes.get(edge.source), boxes.get(edge.target)]
  if (!from || !to || (edge.type === 'transition' && edge.data?.isQuiet)) return ''
  const points = edge.type === 'transition' ? edge.data?.points : undefined
  const ends: readonly Point[] =
    edge.type === 'branch'
      ? [
          { x: from.x + from.width / 2, y: from.y + from.height },
          { x: to.x + to.width / 2, y: to.y },
        ]
      : [
          { x: from.x + from.width, y: from.y + from.height / 2 },
          { x: to.x, y: to.y + to.height / 2 },
        ]
  return (points ?? ends).map(({ x, y }, index) => `${index === 0 ? 'M' : 'L'}${Math.round(x)} ${Math.round(y)}`).join('')
}

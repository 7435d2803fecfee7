/** The graph of a large behavior from far away: plain boxes in the colours of the run, and all arrows as one line. */
import { ViewportPortal, type NodeProps } from '@xyflow/react'
import { createContext, memo, useContext, useMemo, type ComponentType } from 'react'
import { useNodeLive } from '../../api/liveParts'
import type { Course } from '../../document/layout'
import { statusOf } from '../../document/runState'
import type { CanvasNode } from './elements'
import classes from './graph.module.css'

/** More nodes than this are drawn in full only where they are seen. */
export const LARGE_GRAPH_NODES = 300
/** Below this zoom nothing that is written on a node can be read. */
export const LOW_DETAIL_ZOOM = 0.4

/** Whether plain boxes are drawn in the place of everything in full. */
export const LowDetailContext = createContext(false)

/** A kind of node that is a plain box when seen from far away. */
export function withLowDetail<P extends NodeProps<CanvasNode>>(Near: ComponentType<P>): ComponentType<P> {
  return memo(function Levelled(props: P) {
    const isFar = useContext(LowDetailContext)
    return isFar ? <PlainStep id={props.id} type={props.type} selected={props.selected} /> : <Near {...props} />
  })
}

function PlainStep({ id, type, selected }: { id: string; type: string; selected: boolean }) {
  const status = statusOf(useNodeLive(id)?.status ?? 'idle')
  return <div className={classes.far} data-node={type} data-status={status} data-selected={selected || undefined} />
}

/** Every arrow in one path. */
export const LowDetailEdges = memo(function FarCourses({ courses }: { courses: readonly Course[] }) {
  const path = useMemo(() => courses.map(lineOf).join(''), [courses])
  return (
    <ViewportPortal>
      <svg className={classes.farCourses} aria-hidden>
        <path d={path} />
      </svg>
    </ViewportPortal>
  )
})

function lineOf({ points }: Course): string {
  return points.map(({ x, y }, index) => `${index === 0 ? 'M' : 'L'}${Math.round(x)} ${Math.round(y)}`).join('')
}

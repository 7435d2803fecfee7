/** The arrows of machines and the lines of trees on the editor's canvas. */
import { getSmoothStepPath, Position, type EdgeProps } from '@xyflow/react'
import { memo, useMemo } from 'react'
import { shiftOf } from '../../document/editing/shift'
import { isFailure } from '../../document/editing/model'
import { roundedPath, type Point } from '../../document/geometry'
import type { BranchEdge, TransitionEdge } from './elements'
import { openInsertPalette } from './paletteRequests'
import { useTransitionFindings } from './marks'
import { ArrowHeads } from './ArrowHeads'
import classes from './canvas.module.css'

export const TransitionLine = memo(function TransitionPath(props: EdgeProps<TransitionEdge>) {
  const { id, source, data, selected } = props
  const findings = useTransitionFindings(source, data?.outcome ?? '')
  const points = data?.points
  const laidOut = useMemo(() => points && { path: roundedPath(points, 7), middle: middleOf(points) }, [points])
  const from = { x: props.sourceX, y: props.sourceY }
  const to = { x: props.targetX, y: props.targetY }
  const shift = points && shiftOf(points, from, to)
  // As laid out while both its ends are where they were, or have moved together; from port to port otherwise.
  const { path, middle } = shift && laidOut ? laidOut : straight(props)
  return (
    <g transform={shift && (shift.x !== 0 || shift.y !== 0) ? `translate(${shift.x} ${shift.y})` : undefined}>
      {!data?.isQuiet && <path d={path} className="react-flow__edge-interaction" fill="none" strokeOpacity={0} strokeWidth={18} />}
      <path
        d={path}
        className={classes['line']}
        data-line
        data-selected={selected ? true : undefined}
        data-failure={isFailure(data?.outcome ?? '') || undefined}
        data-finding={findings.length > 0 || undefined}
        data-quiet={data?.isQuiet ? true : undefined}
        markerEnd={`url(#edit-arrow${selected ? '-selected' : ''})`}
      >
        {findings.length > 0 && <title>{findings.map((finding) => finding.message).join('\n')}</title>}
      </path>
      {!data?.isQuiet && (
        <g
          className={classes['insert']}
          transform={`translate(${middle.x} ${middle.y})`}
          onPointerDown={(event) => event.stopPropagation()}
          onClick={(event) => {
            event.stopPropagation()
            openInsertPalette(id, { x: event.clientX, y: event.clientY })
          }}
        >
          <title>Insert a state here</title>
          <circle r={9} />
          <path d="M -4 0 H 4 M 0 -4 V 4" />
        </g>
      )}
    </g>
  )
})

/** While a node at one end of it is dragged. */
function straight({ sourceX, sourceY, targetX, targetY }: EdgeProps<TransitionEdge>): { path: string; middle: Point } {
  const [path, x, y] = getSmoothStepPath({
    sourceX,
    sourceY,
    targetX,
    targetY,
    sourcePosition: Position.Right,
    targetPosition: Position.Left,
    borderRadius: 8,
    offset: 18,
  })
  return { path, middle: { x, y } }
}

function middleOf(points: readonly Point[]): Point {
  const lengths = points.slice(1).map((point, index) => Math.hypot(point.x - (points[index]?.x ?? 0), point.y - (points[index]?.y ?? 0)))
  let left = lengths.reduce((sum, length) => sum + length, 0) / 2
  for (const [index, length] of lengths.entries()) {
    const [from, to] = [points[index], points[index + 1]]
    if (from && to && left <= length) {
      const share = length === 0 ? 0 : left / length
      return { x: from.x + (to.x - from.x) * share, y: from.y + (to.y - from.y) * share }
    }
    left -= length
  }
  return points[0] ?? { x: 0, y: 0 }
}

export const BranchLine = memo(function BranchLine({ sourceX, sourceY, targetX, targetY }: EdgeProps<BranchEdge>) {
  const bend = (sourceY + targetY) / 2
  const points = [
    { x: sourceX, y: sourceY },
    { x: sourceX, y: bend },
    { x: targetX, y: bend },
    { x: targetX, y: targetY },
  ]
  return (
    <path
      d={roundedPath(sourceX === targetX ? [points[0] ?? { x: 0, y: 0 }, points[3] ?? { x: 0, y: 0 }] : points, 8)}
      className={classes['branch']}
    />
  )
})

const EDIT_ARROWS = { 'edit-arrow': 'var(--edge)', 'edit-arrow-selected': 'var(--accent)' }

/** The heads of all arrows, once per canvas. */
export function EditArrowHeads() {
  return (
    <svg width={0} height={0} style={{ position: 'absolute' }} aria-hidden>
      <ArrowHeads colours={EDIT_ARROWS} />
    </svg>
  )
}

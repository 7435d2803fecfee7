/** The arrows of machines and the lines of trees on the editor's canvas. */
import { getSmoothStepPath, Position, type EdgeProps } from '@xyflow/react'
import { memo } from 'react'
import { roundedPath, type Point } from '../../document/geometry'
import type { BranchEdge, WayEdge } from './elements'
import { askInsert } from './asking'
import { useWayFindings } from './marks'
import { ArrowHeads } from './ArrowHeads'

const TOLERANCE = 3

export const WayLine = memo(function WayLine(props: EdgeProps<WayEdge>) {
  const { id, source, data, selected } = props
  const findings = useWayFindings(source, data?.outcome ?? '')
  const { path, middle } = courseOf(props, data?.points)
  const classes = `${selected ? ' is-selected' : ''}${findings.length > 0 ? ' has-finding' : ''}${data?.isQuiet ? ' is-quiet' : ''}`
  return (
    <>
      {!data?.isQuiet && (
        <path d={path} className="react-flow__edge-interaction" fill="none" strokeOpacity={0} strokeWidth={18} />
      )}
      <path d={path} className={`way-line${classes}`} markerEnd={`url(#edit-arrow${selected ? '-selected' : ''})`}>
        {findings.length > 0 && <title>{findings.map((finding) => finding.message).join('\n')}</title>}
      </path>
      {!data?.isQuiet && (
        <g
          className="insert"
          transform={`translate(${middle.x} ${middle.y})`}
          onPointerDown={(event) => event.stopPropagation()}
          onClick={(event) => {
            event.stopPropagation()
            askInsert(id, { x: event.clientX, y: event.clientY })
          }}
        >
          <title>Insert a state here</title>
          <circle r={9} />
          <path d="M -4 0 H 4 M 0 -4 V 4" />
        </g>
      )}
    </>
  )
})

/** Along the laid-out points while they fit the ends; from port to port while a node is dragged. */
function courseOf(
  { sourceX, sourceY, targetX, targetY }: EdgeProps<WayEdge>,
  points: readonly Point[] | undefined,
): { path: string; middle: Point } {
  const first = points?.[0]
  const last = points?.at(-1)
  const fits =
    first &&
    last &&
    Math.abs(first.y - sourceY) < TOLERANCE &&
    Math.abs(last.y - targetY) < TOLERANCE &&
    Math.abs(first.x - sourceX) < 12 &&
    Math.abs(last.x - targetX) < 12
  if (points && fits) return { path: roundedPath(points, 7), middle: middleOf(points) }
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
  const lengths = points
    .slice(1)
    .map((point, index) => Math.hypot(point.x - (points[index]?.x ?? 0), point.y - (points[index]?.y ?? 0)))
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
      className="branch-line"
    />
  )
})

const EDIT_ARROWS = ['edit-arrow', 'edit-arrow-selected']

/** The heads of all arrows, once per canvas. */
export function EditArrowHeads() {
  return (
    <svg className="arrow-heads" aria-hidden>
      <ArrowHeads ids={EDIT_ARROWS} />
    </svg>
  )
}

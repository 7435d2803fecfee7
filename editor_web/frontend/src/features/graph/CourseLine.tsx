/** One arrow of a machine along its laid-out course: those that were taken are lit, the latest one most. */
import type { EdgeProps } from '@xyflow/react'
import { memo } from 'react'
import { useNodePart } from '../../api/liveParts'
import { lookup, type Dict } from '../../document/dict'
import { edgeOf, sourceOf, transitionId } from '../../document/edgeId'
import { roundedPath } from '../../document/geometry'
import type { CourseEdge } from './elements'
import classes from './graph.module.css'

const NONE: Dict<number> = {}

export const CourseLine = memo(function CourseLine({ data }: EdgeProps<CourseEdge>) {
  const course = data?.course
  const start = edgeOf(course?.id ?? '')
  const latest = useNodePart(course?.machine ?? '', (live) => start !== undefined && live?.last_transition === transitionId(start))
  const count = useNodePart(start ? sourceOf(start) : '', (live) => lookup(live?.taken ?? NONE, start?.outcome ?? '') ?? 0)
  if (!course) return null
  const isPassed = count > 0 && !latest
  const isFailure = /fail|error|abort/.test(course.outcome)
  return (
    <>
      <path
        d={roundedPath(course.points)}
        className={classes.course}
        data-course={course.outcome}
        data-taken={latest || undefined}
        data-count={count || undefined}
        {...(isPassed ? { style: { stroke: 'var(--done)', strokeWidth: 2.25 } } : {})}
        data-failure={isFailure || undefined}
        markerEnd={`url(#arrow${latest ? '-taken' : isPassed ? '-passed' : ''})`}
      />
      <text
        x={course.label.x}
        y={course.label.y}
        className={classes.label}
        data-taken={latest || undefined}
        {...(isPassed ? { style: { fill: 'var(--done)', fontWeight: 650 } } : {})}
      >
        {count > 1 ? `${course.outcome} ×${count}` : course.outcome}
      </text>
    </>
  )
})

/** The heads of all arrows, once per canvas. */
export function ArrowHeads() {
  return (
    <svg className={classes.heads} aria-hidden>
      <defs>
        {['arrow', 'arrow-taken', 'arrow-passed'].map((id) => (
          <marker key={id} id={id} viewBox="0 0 10 10" refX="8.5" refY="5" markerWidth="7" markerHeight="7" orient="auto">
            <path
              d="M 0 1 L 9 5 L 0 9 z"
              data-taken={id === 'arrow-taken' || undefined}
              {...(id === 'arrow-passed' ? { style: { fill: 'var(--done)' } } : {})}
            />
          </marker>
        ))}
      </defs>
    </svg>
  )
}

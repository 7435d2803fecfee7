/** One arrow of a machine along its laid-out course; the one that was followed last is lit. */
import type { EdgeProps } from '@xyflow/react'
import { memo } from 'react'
import { useNodePart } from '../../api/liveParts'
import { roundedPath } from '../../document/geometry'
import type { CourseEdge } from './elements'
import classes from './graph.module.css'

export const CourseLine = memo(function CourseLine({ data }: EdgeProps<CourseEdge>) {
  const course = data?.course
  const [, source = '', outcome = ''] = (course?.id ?? '').split('|')
  const taken = useNodePart(course?.machine ?? '', (live) => live?.last_transition === `${source}|${outcome}`)
  if (!course) return null
  const isFailure = /fail|error|abort/.test(course.outcome)
  return (
    <>
      <path
        d={roundedPath(course.points)}
        className={classes.course}
        data-course={course.outcome}
        data-taken={taken || undefined}
        data-failure={isFailure || undefined}
        markerEnd={`url(#arrow${taken ? '-taken' : ''})`}
      />
      <text x={course.label.x} y={course.label.y} className={classes.label} data-taken={taken || undefined}>
        {course.outcome}
      </text>
    </>
  )
})

/** The heads of all arrows, once per canvas. */
export function ArrowHeads() {
  return (
    <svg className={classes.heads} aria-hidden>
      <defs>
        {['arrow', 'arrow-taken'].map((id) => (
          <marker key={id} id={id} viewBox="0 0 10 10" refX="8.5" refY="5" markerWidth="7" markerHeight="7" orient="auto">
            <path d="M 0 1 L 9 5 L 0 9 z" data-taken={id === 'arrow-taken' || undefined} />
          </marker>
        ))}
      </defs>
    </svg>
  )
}

/** One part of what a sweep has shown, with a title; an error in it leaves the others as they are. */
import type { ReactNode } from 'react'
import { ViewBoundary } from '../../components/ViewBoundary'

export function SweepCard({
  title,
  isWide = false,
  children,
}: {
  readonly title: string
  readonly isWide?: boolean
  readonly children: ReactNode
}) {
  return (
    <section className={`sweep-card${isWide ? ' is-wide' : ''}`} aria-label={title}>
      <h2>{title}</h2>
      <ViewBoundary name={title}>{children}</ViewBoundary>
    </section>
  )
}

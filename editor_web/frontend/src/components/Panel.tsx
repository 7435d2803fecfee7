/** A titled area of the work space. */
import type { ReactNode } from 'react'
import { ViewBoundary } from './ViewBoundary'

export interface PanelProps {
  readonly title: string
  /** Whose it is, where there are several of that title. */
  readonly of?: string | undefined
  readonly tools?: ReactNode
  readonly children: ReactNode
  /** Stays in sight below what is shown. */
  readonly foot?: ReactNode
  readonly className?: string
}

export function Panel({ title, of, tools, children, foot, className = '' }: PanelProps) {
  return (
    <section className={`panel ${className}`} aria-label={of ? `${title} of ${of}` : title}>
      <header className="panel-header">
        <h2 className="panel-title">{title}</h2>
        {tools}
      </header>
      <div className="panel-body">
        <ViewBoundary name={title}>{children}</ViewBoundary>
      </div>
      {foot && <ViewBoundary name={`What stands below ${title}`}>{foot}</ViewBoundary>}
    </section>
  )
}

/** A titled area of the work space. */
import type { ReactNode } from 'react'

export interface PanelProps {
  readonly title: string
  readonly tools?: ReactNode
  readonly children: ReactNode
  /** Stays in sight below what is shown. */
  readonly foot?: ReactNode
  readonly className?: string
}

export function Panel({ title, tools, children, foot, className = '' }: PanelProps) {
  return (
    <section className={`panel ${className}`} aria-label={title}>
      <header className="panel-header">
        <h2 className="panel-title">{title}</h2>
        {tools}
      </header>
      <div className="panel-body">{children}</div>
      {foot}
    </section>
  )
}

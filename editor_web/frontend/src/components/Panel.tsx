/** A titled area of the work space. */
import { Title } from '@mantine/core'
import type { ReactNode } from 'react'
import classes from './Panel.module.css'
import { ViewBoundary } from './ViewBoundary'

export interface PanelProps {
  readonly title: string
  /** Whose it is, where there are several of that title. */
  readonly of?: string | undefined
  readonly tools?: ReactNode
  /** Show the tools as icons where the panel is narrow; their names stay for those who hear them. */
  readonly hasIcons?: boolean
  readonly children: ReactNode
  /** Stays in sight below what is shown. */
  readonly foot?: ReactNode
  readonly className?: string
}

export function Panel({ title, of, tools, hasIcons = false, children, foot, className = '' }: PanelProps) {
  return (
    <section className={`${classes.panel} ${className}`} data-icons={hasIcons || undefined} aria-label={of ? `${title} of ${of}` : title}>
      <header className={classes.header}>
        <Title order={2} fz="0.84rem" data-panel-title>
          {title}
        </Title>
        {tools}
      </header>
      <div className={classes.body}>
        <ViewBoundary name={title}>{children}</ViewBoundary>
      </div>
      {foot && <ViewBoundary name={`What stands below ${title}`}>{foot}</ViewBoundary>}
    </section>
  )
}

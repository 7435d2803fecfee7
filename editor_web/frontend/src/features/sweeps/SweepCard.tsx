/** One part of what a sweep has shown, with a title; an error in it leaves the others as they are. */
import { Paper, Title } from '@mantine/core'
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
    <Paper
      component="section"
      withBorder
      radius="md"
      p="sm"
      miw={0}
      bg="var(--surface)"
      aria-label={title}
      {...(isWide ? { style: { gridColumn: '1 / -1' } } : {})}
    >
      <Title order={2} fz="0.92rem" mb="2xs">
        {title}
      </Title>
      <ViewBoundary name={title}>{children}</ViewBoundary>
    </Paper>
  )
}

/** A part of a tab, below a line. */
import { Flex, Title } from '@mantine/core'
import type { ReactNode } from 'react'

interface PartProps {
  readonly label: string
  readonly title?: ReactNode
  readonly children: ReactNode
}

export function Part({ label, title, children }: PartProps) {
  return (
    <Flex component="section" direction="column" gap="xs" pt="xs" style={{ borderTop: '1px solid var(--line)' }} aria-label={label}>
      {title && (
        <Title order={3} size="sm">
          {title}
        </Title>
      )}
      {children}
    </Flex>
  )
}

/** A list without signs before its items. */
import { Flex } from '@mantine/core'
import type { ReactNode } from 'react'

export interface PlainListProps {
  readonly label?: string
  readonly gap?: number
  /** Its items. */
  readonly children: ReactNode
}

export function PlainList({ label, gap = 0, children }: PlainListProps) {
  return (
    <Flex component="ul" direction="column" gap={gap} m={0} p={0} style={{ listStyle: 'none' }} aria-label={label}>
      {children}
    </Flex>
  )
}

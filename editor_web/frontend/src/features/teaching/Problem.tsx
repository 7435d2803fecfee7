/** Why something was refused, told at once. */
import { Text } from '@mantine/core'
import type { ReactNode } from 'react'

export function Problem({ children }: { readonly children: ReactNode }) {
  return (
    <Text size="sm" fw={550} c="var(--failed)" role="alert" style={{ overflowWrap: 'anywhere' }}>
      {children}
    </Text>
  )
}

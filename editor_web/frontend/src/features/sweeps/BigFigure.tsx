/** What a sweep tells first, in large digits, with words beside it. */
import { Group, Text } from '@mantine/core'
import type { ReactNode } from 'react'

export function BigFigure({ figure, children }: { readonly figure: string; readonly children: ReactNode }) {
  return (
    <Group gap="sm" align="baseline" style={{ fontVariantNumeric: 'tabular-nums' }}>
      <Text component="strong" fz="1.9rem" fw={660} lh={1.15}>
        {figure}
      </Text>
      {children}
    </Group>
  )
}

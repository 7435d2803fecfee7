/** A button in a text, which looks like a link. */
import { Anchor } from '@mantine/core'
import type { ReactNode } from 'react'

export function TextButton({ onPress, children }: { readonly onPress: () => void; readonly children: ReactNode }) {
  return (
    <Anchor
      component="button"
      type="button"
      inherit
      ta="start"
      style={{ overflowWrap: 'anywhere', verticalAlign: 'baseline' }}
      onClick={onPress}
    >
      {children}
    </Anchor>
  )
}

/** A button in a text, which looks like a link. */
import { Anchor } from '@mantine/core'
import type { ReactNode } from 'react'

interface TextButtonProps {
  /** Its name, where several have the same words; it begins with them. */
  readonly label?: string | undefined
  readonly onPress: () => void
  readonly children: ReactNode
}

export function TextButton({ label, onPress, children }: TextButtonProps) {
  return (
    <Anchor
      component="button"
      type="button"
      aria-label={label}
      inherit
      ta="start"
      style={{ overflowWrap: 'anywhere', verticalAlign: 'baseline' }}
      onClick={onPress}
    >
      {children}
    </Anchor>
  )
}

/** A line about what a sweep has shown. */
import { Text } from '@mantine/core'
import type { ReactNode } from 'react'

export interface NoteProps {
  /** Does it only explain? */
  readonly isQuiet?: boolean
  readonly role?: 'status' | undefined
  readonly id?: string
  readonly children: ReactNode
}

export function Note({ isQuiet = false, role, id, children }: NoteProps) {
  return (
    <Text fz="0.82rem" my={2} role={role} id={id} {...(isQuiet ? { c: 'dimmed' } : {})}>
      {children}
    </Text>
  )
}

/** The title of a part of a card. */
export function PartTitle({ isMono = false, children }: { readonly isMono?: boolean; readonly children: ReactNode }) {
  return (
    <Text
      component="h3"
      fz="0.8rem"
      fw={620}
      mt="2xs"
      mb="4xs"
      {...(isMono ? { ff: 'monospace' } : {})}
      style={{ overflowWrap: 'anywhere' }}
    >
      {children}
    </Text>
  )
}

/** A name out of a document or a file. */
export function Mono({ isQuiet = false, children }: { readonly isQuiet?: boolean; readonly children: ReactNode }) {
  return (
    <Text span ff="monospace" fz="0.92em" {...(isQuiet ? { c: 'dimmed' } : {})}>
      {children}
    </Text>
  )
}

/** The chain of causes of a failure. */
export function Chain({ cause }: { readonly cause: string }) {
  return (
    <Text fz="0.84rem" my="3xs" c="var(--failed)" style={{ overflowWrap: 'anywhere' }}>
      {cause}
    </Text>
  )
}

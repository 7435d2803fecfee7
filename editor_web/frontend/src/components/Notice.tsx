/** A line about what holds the page, the cell or a run up, and what can be done about it. */
import { Group, Text } from '@mantine/core'
import type { ReactNode } from 'react'

export interface NoticeProps {
  readonly icon: ReactNode
  readonly children: ReactNode
  readonly tools?: ReactNode
  readonly role?: 'alert'
  /** Inside of a panel or a dialog, instead of across the page. */
  readonly isInset?: boolean
}

const EDGE = { borderInlineStart: '4px solid var(--failed)', overflowWrap: 'anywhere' } as const
const ACROSS = { ...EDGE, borderBottom: '1px solid var(--line)' } as const

export function Notice({ icon, children, tools, role, isInset = false }: NoticeProps) {
  return (
    <Group gap="xs" px={isInset ? 'xs' : 16} py="3xs" fz="0.86rem" bg="var(--failed-soft)" style={isInset ? EDGE : ACROSS} role={role}>
      <Text span inherit c="var(--failed)" display="flex">
        {icon}
      </Text>
      <Text span inherit flex="1 1 12rem">
        {children}
      </Text>
      {tools}
    </Group>
  )
}

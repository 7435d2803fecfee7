/** A line about what holds the page, the cell or a run up, and what can be done about it. */
import { Group, Text } from '@mantine/core'
import type { ReactNode } from 'react'

export interface NoticeProps {
  readonly icon: ReactNode
  readonly children: ReactNode
  readonly tools?: ReactNode
  readonly role?: 'alert'
}

const EDGES = { borderBottom: '1px solid var(--line)', borderInlineStart: '4px solid var(--failed)', overflowWrap: 'anywhere' } as const

export function Notice({ icon, children, tools, role }: NoticeProps) {
  return (
    <Group gap="xs" px={16} py="3xs" fz="0.86rem" bg="var(--failed-soft)" style={EDGES} role={role}>
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

/** What all forms are made of: a head, lines with a label, words about a part, links. */
import { Anchor, Box, Flex, Text } from '@mantine/core'
import type { ReactNode } from 'react'
import classes from './form.module.css'

export interface FormHeadProps {
  readonly icon?: ReactNode
  readonly title: string
  /** Small words below the title. */
  readonly children: ReactNode
  readonly tools?: ReactNode
}

export function FormHead({ icon, title, children, tools }: FormHeadProps) {
  return (
    <Flex
      component="header"
      align="center"
      gap="xs"
      px="sm"
      py={10}
      style={{ borderBottom: '1px solid var(--line)', overflowWrap: 'anywhere' }}
    >
      <Box flex="none" lh={0} c="dimmed">
        {icon}
      </Box>
      <Box flex={1} miw={0}>
        <Text size="sm" fw={700}>
          {title}
        </Text>
        <Text size="xs" c="dimmed" component="div">
          {children}
        </Text>
      </Box>
      {tools}
    </Flex>
  )
}

export interface FormLineProps {
  readonly label: ReactNode
  /** What it means, for those who hover. */
  readonly title?: string
  /** The field, and what stands after it. */
  readonly children: ReactNode
}

export function FormLine({ label, title, children }: FormLineProps) {
  return (
    <div className={classes['line']}>
      <span title={title}>{label}</span>
      {children}
    </div>
  )
}

/** Words about a part of the form. */
export function FormWords({ children }: { readonly children: ReactNode }) {
  return (
    <Text size="xs" c="dimmed" component="p" style={{ whiteSpace: 'pre-line' }}>
      {children}
    </Text>
  )
}

export interface LinkButtonProps {
  readonly title?: string
  readonly isMono?: boolean
  readonly onPress: () => void
  readonly children: ReactNode
}

/** Leads elsewhere within the editor. */
export function LinkButton({ title, isMono = false, onPress, children }: LinkButtonProps) {
  return (
    <Anchor
      component="button"
      type="button"
      inherit
      ta="left"
      underline="always"
      {...(isMono ? { ff: 'monospace' } : {})}
      title={title}
      onClick={onPress}
    >
      {children}
    </Anchor>
  )
}

/** A part of the form, with its title, that can be closed. */
import { Stack, Text, Title, UnstyledButton } from '@mantine/core'
import { IconChevronDown, IconChevronRight } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import classes from './form.module.css'

export interface SectionProps {
  readonly title: string
  readonly children: ReactNode
  readonly isClosed?: boolean
  /** Small words beside the title. */
  readonly note?: string | undefined
}

export function Section({ title, children, isClosed = false, note }: SectionProps) {
  const [isOpen, setOpen] = useState(!isClosed)
  const Chevron = isOpen ? IconChevronDown : IconChevronRight
  return (
    <section className={classes['section']} aria-label={title}>
      <Title order={3} fz="sm" fw={620}>
        <UnstyledButton w="100%" px="sm" pt={8} pb={5} fz="sm" fw={620} aria-expanded={isOpen} onClick={() => setOpen(!isOpen)}>
          <Chevron size={14} aria-hidden style={{ verticalAlign: '-0.15em', marginInlineEnd: 5 }} />
          {title}
          {note && (
            <Text span size="xs" c="dimmed" ml={6}>
              {note}
            </Text>
          )}
        </UnstyledButton>
      </Title>
      {isOpen && (
        <Stack gap={8} px="sm" pt={2} pb="sm">
          {children}
        </Stack>
      )}
    </section>
  )
}

/** The frame of what is shown of one entry: its name, what it is for, and the way back where there is little room. */
import { ActionIcon, Group, Stack, Text, Title } from '@mantine/core'
import { IconArrowLeft } from '@tabler/icons-react'
import type { ReactNode } from 'react'
import { Words } from '../../components/Words'
import { flowing } from '../../document/values'
import classes from './bus.module.css'

interface DetailProps {
  readonly name: string
  readonly type: string
  readonly doc: string
  readonly onBack: () => void
  readonly children: ReactNode
}

export function Detail({ name, type, doc, onBack, children }: DetailProps) {
  return (
    <section aria-label={name}>
      <Stack gap="2xs" maw="46rem">
        <Group gap="xs" align="baseline">
          <ActionIcon
            className={classes.back ?? ''}
            variant="default"
            size="md"
            style={{ alignSelf: 'center' }}
            aria-label="Back to the list"
            onClick={onBack}
          >
            <IconArrowLeft size={15} aria-hidden />
          </ActionIcon>
          <Title order={3} fz="0.88rem" ff="monospace">
            {name}
          </Title>
          <Text inherit span c="dimmed">
            {type}
          </Text>
        </Group>
        {doc && (
          <Text fz="0.8rem" style={{ whiteSpace: 'pre-line' }}>
            <Words text={flowing(doc)} />
          </Text>
        )}
        {children}
      </Stack>
    </section>
  )
}

/** Why something cannot be sent, or what it may do. */
export function Caution({ mayChange, words }: { mayChange: boolean; words: string }) {
  if (!mayChange)
    return (
      <Text fz="0.8rem" c="dimmed">
        You may look only: log in with the operator token to send anything.
      </Text>
    )
  return (
    <Text fz="0.8rem" px="xs" py="4xs" bg="var(--stopped-soft)" c="var(--stopped)" style={{ borderInlineStart: '3px solid' }}>
      {words}
    </Text>
  )
}

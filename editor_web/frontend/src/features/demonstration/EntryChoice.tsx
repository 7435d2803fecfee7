/** The taught entries and the two actions of the tool; each click adds one to the end of the steps. */
import { Button, Flex, Group, NavLink, Text, TextInput, Title } from '@mantine/core'
import { IconArrowsHorizontal, IconMapPin, IconRoute, IconSearch } from '@tabler/icons-react'
import { useState } from 'react'
import type { EntryName } from '../../api/types'
import { KIND_WORDS, teachable, type Kind } from '../../document/demonstration'
import classes from './Demonstration.module.css'

export interface EntryChoiceProps {
  readonly entries: readonly EntryName[] | undefined
  readonly onAdd: (kind: Kind, name: string) => void
}

export function EntryChoice({ entries, onAdd }: EntryChoiceProps) {
  const [text, setText] = useState('')
  const all = teachable(entries ?? [])
  const words = text.toLowerCase().split(/\s+/).filter(Boolean)
  const fitting = all.filter((entry) => words.every((word) => `${entry.name} ${KIND_WORDS[entry.kind]}`.includes(word)))
  return (
    <Flex component="section" direction="column" gap="xs" aria-label="Taught entries">
      <Title order={3} size="sm">
        Add
      </Title>
      <Group gap="xs">
        <Button variant="default" size="compact-sm" onClick={() => onAdd('action', 'close')}>
          Close gripper
        </Button>
        <Button variant="default" size="compact-sm" onClick={() => onAdd('action', 'open')}>
          Open gripper
        </Button>
      </Group>
      <TextInput
        size="xs"
        leftSection={<IconSearch size={14} aria-hidden />}
        aria-label="Find a taught entry"
        placeholder="Find a taught entry"
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
      />
      <Flex component="ul" direction="column" className={`${classes.scroll} plain-list`}>
        {fitting.map((entry) => (
          <li key={`${entry.kind}:${entry.name}`}>
            <NavLink
              component="button"
              type="button"
              noWrap
              px="xs"
              py={4}
              aria-label={`Add ${KIND_WORDS[entry.kind]} ${entry.name}`}
              leftSection={<EntryIcon kind={entry.kind} />}
              label={entry.name}
              rightSection={
                <Text span size="xs" c="dimmed">
                  {KIND_WORDS[entry.kind]}
                </Text>
              }
              onClick={() => onAdd(entry.kind, entry.name)}
            />
          </li>
        ))}
      </Flex>
      {entries && fitting.length === 0 && (
        <Text size="sm" c="dimmed">
          {all.length === 0 ? 'Nothing has been taught yet: save poses and motions first.' : 'No entry fits.'}
        </Text>
      )}
    </Flex>
  )
}

export function EntryIcon({ kind }: { kind: Kind }) {
  const Icon =
    kind === 'joints' || kind === 'pose' ? IconMapPin : kind === 'gripper' || kind === 'action' ? IconArrowsHorizontal : IconRoute
  return <Icon size={15} color="var(--accent)" aria-hidden />
}

/** The numbers of all topics as a tree to choose from: topics, their fields, rows at once. */
import { Badge, Box, Button, Checkbox, CloseButton, Group, List, Stack, Text, TextInput } from '@mantine/core'
import { IconChevronDown, IconChevronRight, IconSearch } from '@tabler/icons-react'
import { memo, useMemo, useState } from 'react'
import { idOf, rowsOf, shownTopics, type FieldRow } from './fields'
import { MOST_CURVES } from './keptFields'
import type { TopicFields } from '../../api/types'

interface FieldChooserProps {
  readonly topics: readonly TopicFields[]
  readonly chosen: readonly string[]
  readonly onChoose: (fields: readonly string[]) => void
}

/** Not drawn again with every sample. */
export const FieldChooser = memo(function FieldChooser({ topics, chosen, onChoose }: FieldChooserProps) {
  const [search, setSearch] = useState('')
  const [opened, setOpened] = useState<ReadonlySet<string>>(new Set())
  const shown = useMemo(() => shownTopics(topics, search), [topics, search])
  const isFull = chosen.length >= MOST_CURVES

  function toggle(ids: readonly string[], isOn: boolean): void {
    const others = chosen.filter((id) => !ids.includes(id))
    onChoose(isOn ? [...others, ...ids] : others)
  }

  function fold(topic: string): void {
    const next = new Set(opened)
    if (!next.delete(topic)) next.add(topic)
    setOpened(next)
  }

  return (
    <Stack
      gap="3xs"
      px="xs"
      py="2xs"
      mih={0}
      fz="0.8rem"
      style={{ overflowY: 'auto', border: 'solid var(--line)', borderWidth: '0 1px 1px 0' }}
    >
      <TextInput
        size="xs"
        aria-label="Find a number"
        placeholder="Find a number"
        leftSection={<IconSearch size={14} aria-hidden />}
        rightSection={search && <CloseButton size="xs" aria-label="Clear" onClick={() => setSearch('')} />}
        value={search}
        onChange={(event) => setSearch(event.currentTarget.value)}
      />
      {isFull && (
        <Text inherit c="dimmed">
          {MOST_CURVES} curves are the most.
        </Text>
      )}
      {shown.length === 0 && (
        <Text inherit c="dimmed">
          Nothing matches.
        </Text>
      )}
      <List listStyleType="none" fz="inherit" aria-label="Numbers of topics">
        {shown.map((each) => {
          const isOpen = search !== '' || opened.has(each.topic)
          const count = each.fields.filter((field) => chosen.includes(idOf(each.topic, field))).length
          const Chevron = isOpen ? IconChevronDown : IconChevronRight
          return (
            <li key={each.topic}>
              <Button
                variant="subtle"
                color="gray"
                c="var(--text)"
                size="compact-xs"
                justify="start"
                fullWidth
                leftSection={<Chevron size={13} aria-hidden />}
                rightSection={
                  count > 0 && (
                    <Badge component="span" size="sm" variant="light">
                      {count}
                    </Badge>
                  )
                }
                aria-expanded={isOpen}
                onClick={() => fold(each.topic)}
              >
                {each.topic}
              </Button>
              {isOpen &&
                rowsOf(each).map((row) => (
                  <Row key={row.name} topic={each.topic} row={row} chosen={chosen} isFull={isFull} onToggle={toggle} />
                ))}
            </li>
          )
        })}
      </List>
    </Stack>
  )
})

interface RowProps {
  readonly topic: string
  readonly row: FieldRow
  readonly chosen: readonly string[]
  readonly isFull: boolean
  readonly onToggle: (ids: readonly string[], isOn: boolean) => void
}

function Row({ topic, row, chosen, isFull, onToggle }: RowProps) {
  const ids = row.fields.map((field) => idOf(topic, field))
  const on = ids.filter((id) => chosen.includes(id)).length
  const isWhole = row.fields.length > 1
  return (
    <Box pl="lg" pt={3} pb="4xs">
      <Checkbox
        size="xs"
        label={
          <>
            {isWhole ? row.name : (row.fields[0]?.label ?? row.name)}{' '}
            {row.unit && (
              <Text span inherit c="dimmed">
                {row.unit}
              </Text>
            )}
          </>
        }
        aria-label={isWhole ? `All of ${row.name} of ${topic}` : `${row.fields[0]?.label ?? row.name} of ${topic}`}
        checked={on === ids.length}
        indeterminate={on > 0 && on < ids.length}
        disabled={isFull && on === 0}
        onChange={(event) => onToggle(ids, event.currentTarget.checked)}
      />
      {isWhole && (
        <Group gap="4xs" pl="lg" pt="4xs">
          {row.fields.map((field, index) => {
            const id = ids[index] ?? ''
            const isOn = chosen.includes(id)
            const word = field.label.slice(row.name.length).trim()
            return (
              <Button
                key={id}
                size="compact-xs"
                variant={isOn ? 'light' : 'default'}
                aria-pressed={isOn}
                aria-label={`${field.label} of ${topic}`}
                disabled={isFull && !isOn}
                onClick={() => onToggle([id], !isOn)}
              >
                {word}
              </Button>
            )
          })}
        </Group>
      )}
    </Box>
  )
}

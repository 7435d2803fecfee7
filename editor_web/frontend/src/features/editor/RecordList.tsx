/** A list of values with fields: one of them is open at a time; they are moved, deleted and added. */
import { Button, Group, Paper, Stack, UnstyledButton } from '@mantine/core'
import { IconArrowDown, IconArrowUp, IconPlus, IconTrash } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { RowTool } from '../../components/RowTool'
import { reordered } from '../../document/reorder'

interface RecordListProps {
  readonly label: string
  readonly items: readonly unknown[]
  readonly words: (item: unknown) => string
  /** The whole list, changed. */
  readonly onSet: (items: readonly unknown[]) => void
  /** The fields of the item at an index. */
  readonly children: (at: number) => ReactNode
}

const CLOSED = -1

export function RecordList({ label, items, words, onSet, children }: RecordListProps) {
  const [opened, setOpened] = useState(CLOSED)

  function move(at: number, by: 1 | -1): void {
    onSet(reordered(items, at, by))
    setOpened(opened === at ? at + by : CLOSED)
  }

  return (
    <Stack gap={4} role="group" aria-label={label}>
      {items.map((item, at) => (
        // oxlint-disable-next-line react/no-array-index-key -- items may be equal
        <Paper key={at} withBorder p={4}>
          <Group gap={2} wrap="nowrap">
            <UnstyledButton
              flex={1}
              miw={0}
              fz="xs"
              ff="monospace"
              aria-expanded={opened === at}
              onClick={() => setOpened(opened === at ? CLOSED : at)}
            >
              {at}: {words(item)}
            </UnstyledButton>
            <RowTool size={24} label={`Move ${label} ${at} up`} isOff={at === 0} onPress={() => move(at, -1)}>
              <IconArrowUp size={13} aria-hidden />
            </RowTool>
            <RowTool size={24} label={`Move ${label} ${at} down`} isOff={at === items.length - 1} onPress={() => move(at, 1)}>
              <IconArrowDown size={13} aria-hidden />
            </RowTool>
            <RowTool
              size={24}
              label={`Delete ${label} ${at}`}
              onPress={() => {
                onSet(items.toSpliced(at, 1))
                setOpened(CLOSED)
              }}
            >
              <IconTrash size={13} aria-hidden />
            </RowTool>
          </Group>
          {opened === at && children(at)}
        </Paper>
      ))}
      <Button
        variant="default"
        size="compact-xs"
        style={{ alignSelf: 'start' }}
        leftSection={<IconPlus size={13} aria-hidden />}
        aria-label={`Add one to ${label}`}
        onClick={() => {
          onSet([...items, {}])
          setOpened(items.length)
        }}
      >
        Add
      </Button>
    </Stack>
  )
}

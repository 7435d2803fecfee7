/** A list of values with fields: one of them is open at a time; they are moved, deleted and added. */
import { Button, Group, Paper, Stack, UnstyledButton } from '@mantine/core'
import { IconPlus } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { OrderTools } from '../../components/OrderTools'
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
            <OrderTools
              name={`${label} ${at}`}
              isFirst={at === 0}
              isLast={at === items.length - 1}
              onMove={(by) => move(at, by)}
              onDelete={() => {
                onSet(items.toSpliced(at, 1))
                setOpened(CLOSED)
              }}
            />
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

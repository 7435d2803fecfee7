/** What a device has: an axis, belt, sensor or position, with its name and its fields; and the list of what it can get. */
import { ActionIcon, Button, Group, Menu, Stack, Text, TextInput } from '@mantine/core'
import { IconPlus, IconTrash } from '@tabler/icons-react'
import type { ReactNode } from 'react'
import { NEW_ENTRIES } from '../../document/cellDevices'
import { nameFault } from '../../document/cellEditing'
import { withValue, type FieldGroup, type Surroundings } from '../../document/cellFields'
import { freeName } from '../../document/cellNewItems'
import { fieldsOf, lookup, type Dict } from '../../document/dict'

interface EntryGroupProps {
  readonly group: FieldGroup
  readonly newName: string
  readonly onName: (name: string) => void
  readonly onRemove: () => void
  /** The 3D view shows an axis whose fields have the focus. */
  readonly onFocus: () => void
  readonly children: ReactNode
}

export function EntryGroup({ group, newName, onName, onRemove, onFocus, children }: EntryGroupProps) {
  if (!group.title) return children
  return (
    <Stack gap="xs" pt="xs" role="group" aria-label={group.title} onFocusCapture={onFocus} style={{ borderTop: '1px solid var(--line)' }}>
      <Group gap="xs" wrap="nowrap">
        <Text size="sm" fw={600} flex={1} truncate>
          {group.title}
        </Text>
        {group.entry && (
          <>
            <TextInput
              size="xs"
              w="8rem"
              aria-label={`Name of ${group.title}`}
              value={newName}
              error={nameFault(newName) !== undefined}
              onChange={(event) => onName(event.currentTarget.value)}
            />
            <ActionIcon variant="subtle" color="gray" aria-label={`Remove ${group.title}`} onClick={onRemove}>
              <IconTrash size={14} aria-hidden />
            </ActionIcon>
          </>
        )}
      </Group>
      {children}
    </Stack>
  )
}

interface AddEntryProps {
  readonly device: Dict<unknown>
  readonly surroundings: Surroundings
  readonly onAdd: (device: Dict<unknown>) => void
}

export function AddEntry({ device, surroundings, onAdd }: AddEntryProps) {
  return (
    <Menu shadow="md" position="bottom-start">
      <Menu.Target>
        <Button size="compact-xs" variant="default" w="fit-content" leftSection={<IconPlus size={14} aria-hidden />}>
          Axis, sensor, position
        </Button>
      </Menu.Target>
      <Menu.Dropdown aria-label="Add to the device">
        {NEW_ENTRIES.map(({ label, group, stem, value, obstacle }) => {
          const reason = obstacle(device, surroundings)
          return (
            <Menu.Item
              key={label}
              disabled={reason !== undefined}
              title={reason ?? ''}
              onClick={() => {
                const name = freeName(stem, new Set(Object.keys(fieldsOf(lookup(device, group)))))
                onAdd(withValue(device, [group, name], value(device, surroundings)))
              }}
            >
              {label}
            </Menu.Item>
          )
        })}
      </Menu.Dropdown>
    </Menu>
  )
}

/** Adds an item from a list; it is selected then, for its numbers. */
import { Button, Menu } from '@mantine/core'
import { IconPlus } from '@tabler/icons-react'
import { itemAddress } from '../../document/cellEditing'
import type { Surroundings } from '../../document/cellFields'
import { freeName, newItemsOf, type NewItem } from '../../document/cellNewItems'
import { edit } from './session'
import { cellEditor, draftOf, useCellEditor } from './store'

interface AddMenuProps {
  readonly surroundings: Surroundings
  /** Names in the cell that are not in what can be edited: robots, people. */
  readonly taken: readonly string[]
  readonly onSelect: (address: string) => void
}

export function AddMenu({ surroundings, taken, onSelect }: AddMenuProps) {
  const kind = useCellEditor((s) => draftOf(s).kind)

  async function add({ section, stem, label, value }: NewItem): Promise<void> {
    const { items } = draftOf(cellEditor())
    const name = freeName(stem, new Set([...taken, ...items.map((each) => each.name)]))
    const isMade = await edit(`Add ${label.toLowerCase()} ${name}`, [{ edit: 'add_item', section, name, value: value(surroundings) }])
    if (isMade) onSelect(itemAddress({ section, name }))
  }

  return (
    <Menu shadow="md" position="bottom-start">
      <Menu.Target>
        <Button size="compact-xs" variant="default" leftSection={<IconPlus size={14} aria-hidden />}>
          Add
        </Button>
      </Menu.Target>
      <Menu.Dropdown aria-label="Add">
        {newItemsOf(kind).map((each) => {
          const obstacle = each.obstacle(surroundings)
          return (
            <Menu.Item key={each.label} disabled={obstacle !== undefined} title={obstacle ?? ''} onClick={() => void add(each)}>
              {each.label}
            </Menu.Item>
          )
        })}
      </Menu.Dropdown>
    </Menu>
  )
}

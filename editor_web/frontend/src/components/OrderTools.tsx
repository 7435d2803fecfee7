/** The tools of one of several in an order: up, down, delete. */
import { IconArrowDown, IconArrowUp, IconTrash } from '@tabler/icons-react'
import { RowTool } from './RowTool'

interface OrderToolsProps {
  /** Which one, as `waypoint 2`. */
  readonly name: string
  readonly isFirst: boolean
  readonly isLast: boolean
  readonly onMove: (by: 1 | -1) => void
  readonly onDelete: () => void
}

export function OrderTools({ name, isFirst, isLast, onMove, onDelete }: OrderToolsProps) {
  return (
    <>
      <RowTool size={24} label={`Move ${name} up`} isOff={isFirst} onPress={() => onMove(-1)}>
        <IconArrowUp size={13} aria-hidden />
      </RowTool>
      <RowTool size={24} label={`Move ${name} down`} isOff={isLast} onPress={() => onMove(1)}>
        <IconArrowDown size={13} aria-hidden />
      </RowTool>
      <RowTool size={24} label={`Delete ${name}`} onPress={onDelete}>
        <IconTrash size={13} aria-hidden />
      </RowTool>
    </>
  )
}

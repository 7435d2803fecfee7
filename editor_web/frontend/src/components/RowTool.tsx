/** A button of an icon alone at the end of a row, such as that which moves the row up. */
import { ActionIcon, type ActionIconProps } from '@mantine/core'
import type { ReactNode } from 'react'

interface RowToolProps {
  readonly label: string
  readonly isOff?: boolean
  readonly size?: ActionIconProps['size']
  readonly onPress: () => void
  readonly children: ReactNode
}

export function RowTool({ label, isOff = false, size, onPress, children }: RowToolProps) {
  return (
    <ActionIcon
      variant="subtle"
      color="gray"
      {...(size !== undefined && { size })}
      aria-label={label}
      title={label}
      disabled={isOff}
      {...(isOff && { bg: 'transparent' })}
      onClick={onPress}
    >
      {children}
    </ActionIcon>
  )
}

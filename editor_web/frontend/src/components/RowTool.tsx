/** A button of an icon alone at the end of a row, such as that which moves the row up. */
import { ActionIcon, type ActionIconProps } from '@mantine/core'
import type { ReactNode } from 'react'

interface RowToolProps {
  readonly label: string
  /** There is nothing for it to do, which its row shows. */
  readonly isOff?: boolean
  /** Why it cannot be used now: it stays reachable, and says so. */
  readonly obstacle?: string | undefined
  readonly size?: ActionIconProps['size']
  readonly onPress: () => void
  readonly children: ReactNode
}

export function RowTool({ label, isOff = false, obstacle, size, onPress, children }: RowToolProps) {
  const isBlocked = obstacle !== undefined
  return (
    <ActionIcon
      variant="subtle"
      color="gray"
      {...(size !== undefined && { size })}
      aria-label={label}
      aria-disabled={isBlocked || undefined}
      data-disabled={isBlocked}
      title={isBlocked ? `Not possible: ${obstacle}` : label}
      disabled={isOff}
      {...(isOff && { bg: 'transparent' })}
      onClick={() => !isBlocked && onPress()}
    >
      {children}
    </ActionIcon>
  )
}

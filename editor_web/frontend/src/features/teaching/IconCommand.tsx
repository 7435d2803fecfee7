/** A button with nothing but an icon, that stays reachable while it cannot be used, and then says why. */
import { ActionIcon } from '@mantine/core'
import type { ReactNode } from 'react'

interface IconCommandProps {
  readonly label: string
  readonly obstacle?: string | undefined
  readonly icon: ReactNode
  readonly onPress: () => void
}

export function IconCommand({ label, obstacle, icon, onPress }: IconCommandProps) {
  const isOff = obstacle !== undefined
  return (
    <ActionIcon
      variant="subtle"
      color="gray"
      aria-label={label}
      aria-disabled={isOff || undefined}
      data-disabled={isOff}
      title={isOff ? `Not possible: ${obstacle}` : label}
      onClick={() => !isOff && onPress()}
    >
      {icon}
    </ActionIcon>
  )
}

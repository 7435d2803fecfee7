/** A button that is an icon; its name is told to those who hover, and to screen readers. */
import { ActionIcon } from '@mantine/core'
import type { ReactNode } from 'react'
import { useKeyOf } from '../../api/keyMap'
import type { CommandId } from '../../document/commandTable'
import classes from './tool.module.css'

export interface ToolProps {
  readonly label: string
  /** The command that it is; its key is said behind its name. */
  readonly command?: CommandId
  /** What it does, where its name does not say so. */
  readonly title?: string
  /** Given for what is switched on and off. */
  readonly isPressed?: boolean
  readonly isDisabled?: boolean
  /** Beside a field, where there is less room than in a bar. */
  readonly isSmall?: boolean
  readonly onPress: () => void
  readonly children: ReactNode
}

export function Tool({ label, command, title, isPressed, isDisabled = false, isSmall = false, onPress, children }: ToolProps) {
  const key = useKeyOf(command).text
  const name = key ? `${label} (${key})` : label
  return (
    <ActionIcon
      variant={isPressed ? 'light' : 'subtle'}
      color={isPressed ? 'accent' : 'gray'}
      {...(isPressed ? {} : { c: 'dimmed' })}
      size={isSmall ? 24 : 30}
      className={classes['tool']}
      aria-label={name}
      title={title ?? name}
      {...(isPressed === undefined ? {} : { 'aria-pressed': isPressed })}
      disabled={isDisabled}
      onClick={onPress}
    >
      {children}
    </ActionIcon>
  )
}

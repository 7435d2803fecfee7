/** A button that stays reachable while it cannot be used, and then says why. */
import { Button, type ButtonProps } from '@mantine/core'
import type { ReactNode } from 'react'
import { useKeyOf } from '../api/keyMap'
import type { CommandId } from '../document/commandTable'
import classes from './CommandButton.module.css'

export interface CommandButtonProps {
  readonly label: string
  /** Whose it is, for those who hear it, where several have that label. */
  readonly of?: string | undefined
  /** What it does, for those who hover. */
  readonly hint?: string | undefined
  /** Why it cannot be used now. */
  readonly obstacle?: string | undefined
  readonly onObstacle?: (() => void) | undefined
  readonly onPress: () => void
  readonly icon?: ReactNode
  /** The key that does the same. */
  /** The command that it is; its key is said, as it is now. */
  readonly command?: CommandId | undefined
  readonly isPressed?: boolean | undefined
  readonly tone?: 'plain' | 'strong' | 'quiet' | 'danger'
  /** Only the icon is shown where there is little room. */
  readonly isCompact?: boolean
}

const TONES: Readonly<Record<NonNullable<CommandButtonProps['tone']>, ButtonProps>> = {
  plain: { variant: 'default' },
  strong: { variant: 'filled' },
  quiet: { variant: 'subtle', color: 'gray' },
  danger: { variant: 'default', c: 'var(--failed)', bd: '1px solid var(--failed)' },
}

export function CommandButton(props: CommandButtonProps) {
  const { label, of, hint, obstacle, onObstacle, onPress, icon, command, isPressed, tone = 'plain', isCompact = false } = props
  const isOff = obstacle !== undefined
  const key = useKeyOf(command)
  const words = isOff ? `Not possible: ${obstacle}` : [hint, key.text && `Key: ${key.text}`].filter(Boolean).join('. ')
  return (
    <Button
      size="xs"
      px="xs"
      {...(isOff ? { variant: 'default', 'data-disabled': true } : isPressed ? { variant: 'light' } : TONES[tone])}
      leftSection={icon}
      className={classes.command}
      classNames={{ section: classes.icon ?? '', label: classes.label ?? '' }}
      data-compact={isCompact || undefined}
      {...(of ? { 'aria-label': `${label}: ${of}` } : {})}
      aria-disabled={isOff || undefined}
      {...(isPressed === undefined ? {} : { 'aria-pressed': isPressed })}
      {...(key.forReaders ? { 'aria-keyshortcuts': key.forReaders } : {})}
      {...(command ? { 'data-command': command } : {})}
      title={words || undefined}
      onClick={() => (isOff ? onObstacle?.() : onPress())}
    >
      {label}
    </Button>
  )
}

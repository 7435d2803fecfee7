/** A button that stays reachable while it cannot be used, and then says why. */
import type { ReactNode } from 'react'

export interface CommandButtonProps {
  readonly label: string
  /** What it does, for those who hover. */
  readonly hint?: string | undefined
  /** Why it cannot be used now. */
  readonly obstacle?: string | undefined
  readonly onObstacle?: (() => void) | undefined
  readonly onPress: () => void
  readonly icon?: ReactNode
  /** The key that does the same. */
  readonly shortcut?: string | undefined
  readonly isPressed?: boolean | undefined
  readonly tone?: 'plain' | 'strong' | 'quiet' | 'danger'
  /** Only the icon is shown where there is little room. */
  readonly isCompact?: boolean
}

export function CommandButton(props: CommandButtonProps) {
  const { label, hint, obstacle, onObstacle, onPress, icon, shortcut, isPressed, tone = 'plain', isCompact = false } = props
  const isOff = obstacle !== undefined
  const words = isOff ? `Not possible: ${obstacle}` : [hint, shortcut && `Key: ${shortcut}`].filter(Boolean).join('. ')
  return (
    <button
      type="button"
      className={`command is-${tone}${isCompact ? ' is-compact' : ''}`}
      aria-disabled={isOff || undefined}
      {...(isPressed === undefined ? {} : { 'aria-pressed': isPressed })}
      {...(shortcut ? { 'aria-keyshortcuts': shortcut } : {})}
      title={words || undefined}
      onClick={() => (isOff ? onObstacle?.() : onPress())}
    >
      {icon}
      <span className="command-label">{label}</span>
    </button>
  )
}

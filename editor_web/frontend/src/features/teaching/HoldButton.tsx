/** A button that counts only while it is held, by pointer or keyboard. */
import { UnstyledButton } from '@mantine/core'
import type { ReactNode } from 'react'
import classes from './Jog.module.css'

interface HoldButtonProps {
  readonly label: string
  readonly children: ReactNode
  readonly isHeld: boolean
  readonly obstacle: string | undefined
  readonly onHold: () => void
  readonly onLetGo: () => void
}

export function HoldButton({ label, children, isHeld, obstacle, onHold, onLetGo }: HoldButtonProps) {
  const isOff = obstacle !== undefined
  return (
    <UnstyledButton
      className={`${classes.hold} pick-row`}
      data-held={isHeld || undefined}
      aria-label={label}
      aria-disabled={isOff || undefined}
      title={isOff ? `Not possible: ${obstacle}` : `${label}, as long as it is held`}
      onPointerDown={(event) => {
        if (isOff || event.button !== 0) return
        event.currentTarget.setPointerCapture(event.pointerId)
        onHold()
      }}
      onPointerUp={onLetGo}
      onLostPointerCapture={onLetGo}
      onKeyDown={(event) => {
        if (isOff || event.repeat || (event.key !== ' ' && event.key !== 'Enter')) return
        event.preventDefault()
        onHold()
      }}
      onKeyUp={onLetGo}
      onBlur={onLetGo}
      onContextMenu={(event) => event.preventDefault()}
    >
      {children}
    </UnstyledButton>
  )
}

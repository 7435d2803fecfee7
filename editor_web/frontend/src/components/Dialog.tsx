/** A dialog over the page: the browser's own, which keeps the keyboard inside and closes with Escape. */
import { CloseButton, Group, Title } from '@mantine/core'
import { useId, useRef, type KeyboardEvent, type ReactNode } from 'react'
import classes from './Dialog.module.css'
import { useModal } from './modal'
import { ViewBoundary } from './ViewBoundary'

export interface DialogProps {
  readonly isOpen: boolean
  readonly title: string
  /** There is room for a view beside what is said. */
  readonly isWide?: boolean
  readonly onClose: () => void
  readonly children: ReactNode
}

const WIDE = { width: 'min(68rem, calc(100vw - 24px))', maxWidth: 'none' } as const

export function Dialog({ isOpen, title, isWide = false, onClose, children }: DialogProps) {
  const element = useRef<HTMLDialogElement>(null)
  const id = useId()
  useModal(element, isOpen)
  if (!isOpen) return null
  return (
    // oxlint-disable-next-line jsx-a11y/click-events-have-key-events, jsx-a11y/no-noninteractive-element-interactions -- Escape closes it too
    <dialog
      ref={element}
      className={`dialog ${classes.dialog}`}
      style={isWide ? WIDE : undefined}
      aria-labelledby={id}
      onClose={onClose}
      onClick={(event) => event.target === element.current && onClose()}
      onKeyDown={keepOpenBehindList}
    >
      <div className={classes.body}>
        <Group justify="space-between" wrap="nowrap" mb="2xs">
          <Title order={2} size="md" id={id}>
            {title}
          </Title>
          <CloseButton aria-label="Close" onClick={onClose} />
        </Group>
        <ViewBoundary name={title}>{children}</ViewBoundary>
      </div>
    </dialog>
  )
}

/** Escape closes the opened list of a field, and not the dialog around it. */
function keepOpenBehindList(event: KeyboardEvent<HTMLDialogElement>): void {
  if (event.key === 'Escape' && event.target instanceof HTMLElement && 'expanded' in event.target.dataset) event.preventDefault()
}

/** A button that asks before it does what moves something or lets something move. */
import { Button, Group, Modal, type ButtonProps } from '@mantine/core'
import { useState, type ReactNode } from 'react'

export interface ConfirmProps {
  readonly label: string
  /** The question, as a title. */
  readonly title: string
  /** What moves, and what to look at before. */
  readonly children: ReactNode
  readonly onConfirm: () => void
  readonly disabled: boolean
  readonly loading?: boolean
  readonly variant?: ButtonProps['variant']
}

export function Confirm({ label, title, children, onConfirm, disabled, loading = false, variant = 'default' }: ConfirmProps) {
  const [isAsked, setAsked] = useState(false)
  return (
    <>
      <Button size="xs" variant={variant} disabled={disabled} loading={loading} onClick={() => setAsked(true)}>
        {label}
      </Button>
      <Modal opened={isAsked} onClose={() => setAsked(false)} title={title} centered closeButtonProps={{ 'aria-label': 'Close' }}>
        {children}
        <Group justify="flex-end" gap="xs" mt="md">
          <Button variant="default" onClick={() => setAsked(false)}>
            Cancel
          </Button>
          <Button
            data-autofocus
            onClick={() => {
              setAsked(false)
              onConfirm()
            }}
          >
            {label}
          </Button>
        </Group>
      </Modal>
    </>
  )
}

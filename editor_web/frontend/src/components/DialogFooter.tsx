/** The end of a dialog: what was refused, and under it the buttons; the one that does it last. */
import { Button, Group } from '@mantine/core'
import type { ReactNode } from 'react'
import { Refusal } from './Refusal'

export interface DialogFooterProps {
  readonly refusal?: ReactNode
  readonly onCancel?: () => void
  /** The buttons that do something. */
  readonly children: ReactNode
}

export function DialogFooter({ refusal, onCancel, children }: DialogFooterProps) {
  return (
    <>
      <Refusal>{refusal}</Refusal>
      <Group justify="flex-end" gap="xs">
        {onCancel && (
          <Button variant="default" onClick={onCancel}>
            Cancel
          </Button>
        )}
        {children}
      </Group>
    </>
  )
}

/** What all wizards look like: the parts of the value, the 3D view beside them, and the button that takes it. */
import { Alert, Box, Button, Group, Stack, Text } from '@mantine/core'
import { IconAlertTriangle } from '@tabler/icons-react'
import { useEffect, useState, type ReactNode } from 'react'
import { useTeach } from '../../api/teaching'
import { CommandButton } from '../../components/CommandButton'
import { Dialog } from '../../components/Dialog'

export interface WizardFrameProps {
  readonly title: string
  /** The 3D view; undefined where there is none. */
  readonly view: ReactNode
  readonly isNarrow: boolean
  /** Why the value cannot be taken; empty where nothing is taken or typed yet. */
  readonly fault: string | undefined
  readonly onUse: () => void
  readonly onClose: () => void
  readonly children: ReactNode
}

export function WizardFrame({ title, view, isNarrow, fault, onUse, onClose, children }: WizardFrameProps) {
  const refusal = useTeach((s) => s.refused.look)
  const hasView = view !== undefined && !isNarrow
  useFocusBack()
  return (
    <Dialog isOpen isWide={hasView} title={title} onClose={onClose}>
      <Group align="stretch" gap="md" wrap="nowrap" mt="xs">
        <Stack gap="sm" flex={1} miw={0}>
          {children}
          {refusal && (
            <Text size="xs" c="var(--failed)" role="status">
              {[refusal.message, refusal.hint].filter(Boolean).join(' – ')}
            </Text>
          )}
          {fault && (
            <Alert variant="light" color="yellow" py={6} px="xs" icon={<IconAlertTriangle size={14} aria-hidden />} role="status">
              <Text size="xs">{fault}</Text>
            </Alert>
          )}
          <Group gap="xs" justify="end">
            <Button variant="default" size="xs" onClick={onClose}>
              Cancel
            </Button>
            <CommandButton label="Use this value" tone="strong" obstacle={fault} onPress={onUse} />
          </Group>
        </Stack>
        {hasView && (
          <Box flex={1} miw={0} mih="26rem" bd="1px solid var(--line)" style={{ borderRadius: 6, overflow: 'hidden' }}>
            {view}
          </Box>
        )}
      </Group>
    </Dialog>
  )
}

/** The keyboard is again where it was before, unless something else has taken it. */
function useFocusBack(): void {
  const [before] = useState(() => document.activeElement)
  useEffect(
    () => () => {
      if (before instanceof HTMLElement && document.activeElement === document.body) before.focus()
    },
    [before],
  )
}

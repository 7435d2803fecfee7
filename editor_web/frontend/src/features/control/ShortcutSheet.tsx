/** All keys of the run view, and the switch for those who speak to their computer. */
import { Group, Kbd, Switch, Text } from '@mantine/core'
import { Dialog } from '../../components/Dialog'
import { TourButton } from '../../components/TourButton'
import { SHORTCUTS } from '../../document/shortcuts'

export interface ShortcutSheetProps {
  readonly isOpen: boolean
  readonly onClose: () => void
  readonly areOn: boolean
  readonly onSwitch: (on: boolean) => void
}

export function ShortcutSheet({ isOpen, onClose, areOn, onSwitch }: ShortcutSheetProps) {
  return (
    <Dialog isOpen={isOpen} onClose={onClose} title="Keyboard">
      <dl style={{ margin: 0 }}>
        {SHORTCUTS.map(({ key, words }) => (
          <Group key={key} gap="sm" py={3} wrap="nowrap">
            <Text component="dt" w="2.2em">
              <Kbd>{key}</Kbd>
            </Text>
            <Text component="dd" size="sm" m={0}>
              {words}
            </Text>
          </Group>
        ))}
      </dl>
      <Text size="sm" c="var(--quiet)" my="sm">
        In the outline, arrow keys move and Enter chooses. Keys do nothing while you write in a field.
      </Text>
      <TourButton onOpened={onClose} />
      <Switch mt="sm" label="Single keys are commands" checked={areOn} onChange={(event) => onSwitch(event.currentTarget.checked)} />
    </Dialog>
  )
}

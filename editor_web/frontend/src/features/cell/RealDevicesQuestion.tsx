/** Asks before the first motion of real devices. */
import { Button, Group, List, Modal, Text } from '@mantine/core'
import { answerRealDevices, useRealDevices } from '../../api/realDevices'
import { useSession } from '../../api/session'
import { realDevices } from '../../document/devices'

export function RealDevicesQuestion() {
  const isAsked = useRealDevices((s) => s.answer !== undefined)
  const session = useSession((s) => s.session)
  return (
    <Modal
      opened={isAsked}
      onClose={() => answerRealDevices(false)}
      title="Real devices will move"
      centered
      closeButtonProps={{ 'aria-label': 'Close' }}
    >
      <Text size="sm">These devices are not simulated. Look that nobody is in their reach, and have the emergency stop at hand.</Text>
      <List size="sm" my="xs" aria-label="Real devices">
        {realDevices(session).map((each) => (
          <List.Item key={each.device}>
            {each.device}, driver {each.driver}
          </List.Item>
        ))}
      </List>
      <Group justify="flex-end" gap="xs" mt="md">
        <Button variant="default" data-autofocus onClick={() => answerRealDevices(false)}>
          Cancel
        </Button>
        <Button onClick={() => answerRealDevices(true)}>They may move</Button>
      </Group>
    </Modal>
  )
}

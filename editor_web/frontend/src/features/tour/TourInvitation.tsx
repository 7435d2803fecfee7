/** On the first page, for whoever has not been through the tour. */
import { Box, Flex, Group } from '@mantine/core'
import { leaveTour, useTour } from '../../api/tour'
import { CommandButton } from '../../components/CommandButton'
import { TourButton } from '../../components/TourButton'

export function TourInvitation() {
  const isSettled = useTour((s) => s.isSettled)
  if (isSettled) return null
  return (
    <Flex
      component="section"
      wrap="wrap"
      align="center"
      gap="xs"
      p="sm"
      bg="var(--accent-soft)"
      fz="sm"
      style={{ borderBottom: '1px solid var(--line)' }}
      aria-label="First steps"
    >
      <Box flex="1 1 14rem">
        <strong>New here?</strong> Build a behavior of two states and run it. It takes two minutes, and you do every step yourself.
      </Box>
      <Group gap={6}>
        <TourButton />
        <CommandButton label="Not now" tone="quiet" onPress={leaveTour} />
      </Group>
    </Flex>
  )
}

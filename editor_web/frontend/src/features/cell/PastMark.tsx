/** Says over the 3D view that it shows the past, or why it does not. */
import { Box, Group, Text } from '@mantine/core'
import { IconHistory } from '@tabler/icons-react'
import { usePast } from '../../api/past'
import { duration } from '../../document/time'

// A recording has messages so often; what is later than its end by more was not recorded.
const SLACK_S = 0.5

export function PastMark() {
  const { requested, shown } = usePast()
  if (requested === null || shown === null) return null
  const { run, time_s, until_s, problem } = shown
  const isAfter = time_s > until_s + SLACK_S
  return (
    <Box pos="absolute" inset={0} bd={problem ? 0 : '3px solid var(--stopped)'} style={{ pointerEvents: 'none' }}>
      <Group
        data-mark="past"
        wrap="nowrap"
        gap={6}
        mx="auto"
        mt="xs"
        px="xs"
        py={4}
        w="max-content"
        maw="calc(100% - 1.5rem)"
        c="var(--stopped)"
        bg="var(--stopped-soft)"
        bd="1px solid var(--stopped)"
        bdrs="xl"
        title={run}
      >
        <IconHistory size={15} style={{ flex: 'none' }} aria-hidden />
        <Text span size="xs" fw={600} textWrap="nowrap">
          {problem ? `Live: ${problem}` : isAfter ? `Recorded until ${duration(until_s)}` : duration(Math.max(0, time_s))}
        </Text>
        {!problem && (
          <Text span size="xs" truncate>
            of {run}
          </Text>
        )}
      </Group>
    </Box>
  )
}

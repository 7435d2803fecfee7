/** Says over the 3D view that it shows the past, or why it does not. */
import { Group, Text } from '@mantine/core'
import { IconHistory } from '@tabler/icons-react'
import { usePast } from '../../api/past'
import { duration } from '../../document/time'
import classes from './Cell.module.css'

// A recording has messages so often; what is later than its end by more was not recorded.
const SLACK_S = 0.5

export function PastMark() {
  const { requested, shown } = usePast()
  if (requested === null || shown === null) return null
  const { run, time_s, until_s, problem } = shown
  const isAfter = time_s > until_s + SLACK_S
  return (
    <Group className={classes.mark} data-mark="past" wrap="nowrap" gap={6} px="xs" py={4} title={run}>
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
  )
}

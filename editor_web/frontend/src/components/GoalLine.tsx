/** How far the goal of a node is: a bar where its feedback tells a share, and its words. */
import { Group, Progress, Text } from '@mantine/core'
import { lookup } from '../document/dict'
import { useGoals } from '../api/goals'
import { useLive } from '../api/live'

export function GoalLine({ path }: { path: string }) {
  const goal = useGoals((s) => lookup(s.goals, path))
  // What is under way now is no part of a moment of the past.
  const isNow = useLive((s) => s.past === undefined)
  if (!goal || !isNow) return null
  const percent = goal.share === null ? undefined : Math.round(goal.share * 100)
  const words = [percent !== undefined && `${percent} %`, goal.words].filter(Boolean).join(', ') || goal.address
  return (
    <Group gap="3xs" wrap="nowrap" miw={0} flex={1} c="var(--active)" title={`${goal.address} ${goal.status}`}>
      <Text inherit truncate style={{ fontVariantNumeric: 'tabular-nums' }}>
        {words}
      </Text>
      {percent !== undefined && (
        <Progress
          flex={1}
          miw={24}
          size={5}
          bg="var(--line)"
          color="var(--active)"
          value={percent}
          aria-label={`Progress of ${goal.address}`}
        />
      )}
    </Group>
  )
}

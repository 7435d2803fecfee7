/** The gripper or hand of an arm: what it measures, open and close. */
import { Group, Text } from '@mantine/core'
import { IconHandGrab, IconHandStop } from '@tabler/icons-react'
import type { ArmInfo, ArmLive } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import type { Steps } from './useSteps'

/** Closes on whatever is there: held is what stops the fingers. */
const GRASP = { width_m: 0.0, force_n: 20, tolerance_inner_m: 0.5, tolerance_outer_m: 0.5 }

export function ToolRow({
  arm,
  now,
  steps,
  obstacle,
}: {
  readonly arm: ArmInfo
  readonly now: ArmLive | undefined
  readonly steps: Steps
  readonly obstacle: string | undefined
}) {
  const isGripper = arm.skills.includes('gripper/gripper_open')
  const isHand = arm.skills.includes('hand/hand_open')
  if (!isGripper && !isHand) return null
  const off = obstacle ?? (steps.isBusy ? 'wait until the last command has ended' : undefined)
  return (
    <Group gap="xs" pt="xs" style={{ borderTop: '1px solid var(--line)' }} role="group" aria-label="Tool">
      <Text span size="sm" fw={620}>
        {isGripper ? 'Gripper' : 'Hand'}
      </Text>
      <Text span size="sm" c="dimmed" mr="auto">
        {toolWords(now)}
      </Text>
      <CommandButton
        label="Open"
        icon={<IconHandStop size={15} aria-hidden />}
        obstacle={off}
        onPress={() => (isGripper ? steps.send(`${arm.name}/gripper/gripper_open`, {}) : steps.send(`${arm.name}/hand/hand_open`, {}))}
      />
      <CommandButton
        label="Close"
        icon={<IconHandGrab size={15} aria-hidden />}
        obstacle={off}
        onPress={() =>
          isGripper ? steps.send(`${arm.name}/gripper/gripper_grasp`, GRASP) : steps.send(`${arm.name}/hand/hand_close`, { percent: 100 })
        }
      />
    </Group>
  )
}

/** What the tool measures, in words. */
export function toolWords(now: ArmLive | undefined): string {
  const tool = now?.tool
  if (!tool) return ''
  const opening =
    tool.width_m !== null
      ? `${(tool.width_m * 1000).toFixed(0)} mm open`
      : tool.closed_percent !== null
        ? `${tool.closed_percent.toFixed(0)} % closed`
        : ''
  return [opening, tool.held ? 'holds something' : ''].filter(Boolean).join(', ')
}

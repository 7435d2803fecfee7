/** The arm that a value is taught with: which one, where its tool is now, and how it is jogged there. */
import { Box, Collapse, Group, NativeSelect, Stack, Text } from '@mantine/core'
import { IconHandFinger } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { useTeach } from '../../api/teaching'
import { CommandButton } from '../../components/CommandButton'
import { lookup } from '../../document/dict'
import { poseFrom, type PlacedPose } from '../../document/poses'
import { degrees, rollPitchYaw } from '../../document/teaching'

export interface TaughtArmProps {
  readonly arm: string
  readonly onArm: (arm: string) => void
  /** The panel that jogs an arm. */
  readonly jog: (arm: string) => ReactNode
}

export function TaughtArm({ arm, onArm, jog }: TaughtArmProps) {
  const arms = useTeach((s) => s.arms)
  const pose = useTool(arm)
  const [isJogging, setJogging] = useState(false)
  const obstacle = useArmObstacle(arm)
  return (
    <Stack gap={6}>
      <Group gap="xs" align="end">
        <NativeSelect
          size="xs"
          label="Arm"
          value={arm}
          data={[...(arms?.some((each) => each.name === arm) ? [] : [arm]), ...(arms?.map((each) => each.name) ?? [])]}
          onChange={(event) => onArm(event.currentTarget.value)}
        />
        <CommandButton
          label="Jog"
          hint="Move the arm by hand"
          icon={<IconHandFinger size={15} aria-hidden />}
          isPressed={isJogging}
          obstacle={obstacle}
          onPress={() => setJogging(!isJogging)}
        />
      </Group>
      <Text size="xs" c="dimmed" role="status" aria-label="Present pose of the tool">
        {obstacle ?? (pose ? `Tool now: ${poseWords(pose)}` : 'Where the tool is, is not known yet')}
      </Text>
      <Collapse expanded={isJogging && obstacle === undefined}>{isJogging && <Box>{jog(arm)}</Box>}</Collapse>
    </Stack>
  )
}

/** The arm of a request, or the first one of the cell, until somebody chooses another. */
export function useArm(asked: string): readonly [string, (arm: string) => void] {
  const arms = useTeach((s) => s.arms)
  const [chosen, setChosen] = useState('')
  return [chosen || asked || (arms?.[0]?.name ?? ''), setChosen]
}

/** Where the tool centre point is in the world; undefined while nothing is known. */
export function useTool(arm: string): PlacedPose | undefined {
  const now = useTeach((s) => lookup(s.now, arm))
  return poseFrom(now?.tool_pose)
}

/** Why nothing can be taken from the arm. */
export function useArmObstacle(arm: string): string | undefined {
  const isOpen = useTeach((s) => s.isOpen)
  const arms = useTeach((s) => s.arms)
  if (arms === undefined || !isOpen) return 'the server has not told of its arms yet'
  if (arms.length === 0) return 'the open cell has no arm'
  return arms.some((each) => each.name === arm) ? undefined : `the open cell has no arm ${arm}: choose another one`
}

export function poseWords({ xyz, xyzw }: PlacedPose): string {
  const angles = rollPitchYaw(xyzw).map((each) => degrees(each).toFixed(1))
  return `${xyz.map((each) => each.toFixed(4)).join(', ')} m, ${angles.join(', ')}°`
}

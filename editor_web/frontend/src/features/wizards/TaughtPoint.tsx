/** One point of several: taken with the tool, or typed. */
import { Group } from '@mantine/core'
import { IconFocusCentered } from '@tabler/icons-react'
import { CommandButton } from '../../components/CommandButton'
import { roundedTo, type Vector } from '../../document/poses'
import { useArmObstacle, useTool } from './TaughtArm'
import { VectorFields } from '../../components/VectorFields'

export interface TaughtPointProps {
  readonly label: string
  readonly arm: string
  readonly point: Vector | undefined
  readonly onChange: (point: Vector) => void
}

export function TaughtPoint({ label, arm, point, onChange }: TaughtPointProps) {
  const tool = useTool(arm)
  const obstacle = useArmObstacle(arm) ?? (tool ? undefined : 'where the tool is, is not known yet')
  return (
    <Group gap={6} wrap="nowrap">
      <VectorFields
        label={label}
        names={['x', 'y', 'z']}
        unit="m"
        values={point ?? [0, 0, 0]}
        onChange={([x = 0, y = 0, z = 0]) => onChange([x, y, z])}
      />
      <CommandButton
        label={point ? 'Take again' : 'Take'}
        of={label}
        hint={`${label}: where the tool is now`}
        icon={<IconFocusCentered size={15} aria-hidden />}
        obstacle={obstacle}
        onPress={() => tool && onChange(roundedTo(tool.xyz))}
      />
    </Group>
  )
}

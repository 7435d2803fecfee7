/** Which arm is taught, what it does, and what is captured of it. */
import { lookup } from '../../document/dict'
import { IconFlag, IconHandGrab, IconPlayerRecordFilled, IconPlayerStopFilled, IconTopologyRing3 } from '@tabler/icons-react'
import { Box, Group, SegmentedControl, Text } from '@mantine/core'
import { useState } from 'react'
import { wordsOf } from '../../api/client'
import { teach, useDisabledReason, useTeach } from '../../api/teaching'
import type { ArmInfo, Trigger } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { StatusBadge } from '../../components/StatusBadge'
import type { Status } from '../../document/runState'
import { FrameCapture } from './FrameCapture'
import { Refusal } from '../../components/Refusal'
import { toolWords } from './ToolRow'

const LOOKS: Readonly<Record<string, Status>> = {
  moving: 'active',
  jogging: 'active',
  guiding: 'active',
  reflex: 'failed',
  fault: 'failed',
  direct: 'warning',
}

interface ArmHeadProps {
  readonly arms: readonly ArmInfo[]
  readonly arm: ArmInfo
  readonly onArm: (name: string) => void
}

export function ArmHead({ arms, arm, onArm }: ArmHeadProps) {
  const now = useTeach((s) => lookup(s.now, arm.name))
  const hand = useTeach((s) => s.hand)
  const off = useDisabledReason()
  const [problem, setProblem] = useState('')
  const isRecording = hand?.recording.includes(arm.name) ?? false
  const obstacle = off ?? (hand === null ? 'this server has no Helping Hand' : undefined)
  const tool = toolWords(now)
  const look = LOOKS[now?.mode ?? ''] ?? 'idle'

  function take(callback: Trigger['trig_callback'], pressed = true): void {
    attempt(teach.now(arm.name, callback, pressed))
  }

  function attempt(work: Promise<unknown>): void {
    work.then(
      () => setProblem(''),
      (error: unknown) => setProblem(wordsOf(error)),
    )
  }

  return (
    <Group gap="xs" px="md" py={6} bg="var(--surface)" style={{ borderBottom: '1px solid var(--line)' }}>
      {arms.length > 1 ? (
        <SegmentedControl size="xs" aria-label="Arm" value={arm.name} onChange={onArm} data={arms.map((each) => each.name)} />
      ) : (
        <strong>{arm.name}</strong>
      )}
      <Box component="span" role="status" aria-label={`State of ${arm.name}`}>
        <StatusBadge look={look} words={now?.mode === 'guiding' ? 'floats' : (now?.mode ?? 'unknown')} />
      </Box>
      {tool && (
        <Text span size="sm" c="dimmed">
          {tool}
        </Text>
      )}
      <Group gap={6} ml="auto" role="group" aria-label="Capture">
        <CommandButton
          label="Joints"
          hint="Capture where the joints are"
          icon={<IconTopologyRing3 size={15} aria-hidden />}
          obstacle={obstacle}
          onPress={() => take('joint_save')}
        />
        <CommandButton
          label="Pose"
          hint="Capture where the tool is"
          icon={<IconFlag size={15} aria-hidden />}
          obstacle={obstacle}
          onPress={() => take('pose_save')}
        />
        {arm.skills.includes('gripper/gripper_open') && (
          <CommandButton
            label="Grip"
            hint="Capture the state of the gripper"
            icon={<IconHandGrab size={15} aria-hidden />}
            obstacle={obstacle}
            onPress={() => take('gripper_save')}
          />
        )}
        <FrameCapture obstacle={obstacle} onCapture={(source, target) => attempt(teach.frame(arm.name, source, target))} />
        {isRecording ? (
          <CommandButton
            label="End recording"
            tone="danger"
            icon={<IconPlayerStopFilled size={14} aria-hidden />}
            obstacle={obstacle}
            onPress={() => take('joint_dmp_save', false)}
          />
        ) : (
          <>
            <CommandButton
              label="Record"
              hint="Record a motion, in joints"
              icon={<IconPlayerRecordFilled size={14} aria-hidden />}
              obstacle={obstacle}
              onPress={() => take('joint_dmp_save')}
            />
            <CommandButton
              label="Record tool"
              hint="Record a motion of the tool"
              icon={<IconPlayerRecordFilled size={14} aria-hidden />}
              obstacle={obstacle}
              onPress={() => take('cart_dmp_save')}
            />
          </>
        )}
      </Group>
      {hand?.said && (
        <Text size="sm" c="dimmed" flex="1 0 100%" role="status" aria-label="Messages of the Helping Hand">
          {hand.said}
        </Text>
      )}
      <Refusal>{problem}</Refusal>
    </Group>
  )
}

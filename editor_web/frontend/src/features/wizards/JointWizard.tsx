/** A configuration of an arm: taken from it, or set joint by joint within its limits. */
import { Group, NumberInput, Slider, Stack, Text } from '@mantine/core'
import { IconFocusCentered } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { useTeach } from '../../api/teaching'
import type { ArmInfo } from '../../api/types'
import type { PlainRequest } from '../../api/valueWizard'
import { CommandButton } from '../../components/CommandButton'
import { lookup } from '../../document/dict'
import { roundedTo } from '../../document/poses'
import { degrees } from '../../document/teaching'
import { TaughtArm, useArm, useArmObstacle } from './TaughtArm'
import { useShownValue } from './useShownValue'
import { WizardFrame } from './WizardFrame'

export interface PlainWizardProps {
  readonly asked: PlainRequest
  readonly jog: (arm: string) => ReactNode
  readonly view: ReactNode
  readonly isNarrow: boolean
  readonly onClose: () => void
}

export function JointWizard({ asked, jog, view, isNarrow, onClose }: PlainWizardProps) {
  const [arm, setArm] = useArm(asked.arm)
  const [joints, setJoints] = useState(() => numbersOf(asked.value))
  const arms = useTeach((s) => s.arms)
  const info = arms?.find((each) => each.name === arm)
  const now = useTeach((s) => lookup(s.now, arm)?.joints)
  const obstacle = useArmObstacle(arm) ?? (now ? undefined : 'its joints are not known yet')
  useShownValue(arm, joints && info && joints.length === info.joint_names.length ? { kind: 'joints', joints } : undefined)
  return (
    <WizardFrame
      title={`Teach ${asked.title}`}
      view={view}
      isNarrow={isNarrow}
      fault={jointFault(joints, info, arm)}
      onUse={() => {
        asked.onSet(joints)
        onClose()
      }}
      onClose={onClose}
    >
      <TaughtArm arm={arm} onArm={setArm} jog={jog} />
      <div>
        <CommandButton
          label="Take the present joints"
          icon={<IconFocusCentered size={15} aria-hidden />}
          obstacle={obstacle}
          onPress={() => now && setJoints(roundedTo(now))}
        />
      </div>
      {info && (
        <Stack gap={6}>
          {info.joint_names.map((name, at) => (
            <JointRow
              key={name}
              name={name}
              lower={info.lower_rad[at] ?? -Math.PI}
              upper={info.upper_rad[at] ?? Math.PI}
              value={(joints ?? now)?.[at] ?? 0}
              onChange={(value) => {
                const base = joints ?? now ?? []
                setJoints(info.joint_names.map((_, each) => (each === at ? value : Number((base[each] ?? 0).toFixed(4)))))
              }}
            />
          ))}
        </Stack>
      )}
    </WizardFrame>
  )
}

interface JointRowProps {
  readonly name: string
  readonly lower: number
  readonly upper: number
  readonly value: number
  readonly onChange: (value: number) => void
}

function JointRow({ name, lower, upper, value, onChange }: JointRowProps) {
  return (
    <Group gap="xs" wrap="nowrap">
      <Text size="xs" w="7rem" flex="none" truncate title={name}>
        {name}
      </Text>
      <Slider
        flex={1}
        size="sm"
        min={lower}
        max={upper}
        step={0.001}
        value={value}
        onChange={(next) => onChange(Number(next.toFixed(4)))}
        label={(shown) => `${degrees(shown).toFixed(1)}°`}
        thumbLabel={name}
      />
      <NumberInput
        size="xs"
        w="5.5rem"
        flex="none"
        hideControls
        aria-label={`${name} in radians`}
        decimalScale={4}
        value={Number(value.toFixed(4))}
        onChange={(next) => typeof next === 'number' && onChange(next)}
        rightSection={
          <Text span size="xs" c="dimmed">
            rad
          </Text>
        }
        rightSectionWidth={28}
      />
      <Text size="xs" c="dimmed" w="3.5rem" flex="none" ta="right">
        {degrees(value).toFixed(1)}°
      </Text>
    </Group>
  )
}

/** The configuration that stands in the document; undefined where it is none. */
function numbersOf(value: unknown): readonly number[] | undefined {
  const isPlain = Array.isArray(value) && value.length > 0 && value.every((each) => typeof each === 'number')
  return isPlain ? value : undefined
}

function jointFault(joints: readonly number[] | undefined, info: ArmInfo | undefined, arm: string): string | undefined {
  if (!joints) return 'Take the present joints, or move a slider'
  if (!info) return undefined
  if (joints.length !== info.joint_names.length)
    return `${arm} has ${info.joint_names.length} joints, and not ${joints.length}: take them anew`
  const at = joints.findIndex((value, index) => value < (info.lower_rad[index] ?? -Infinity) || value > (info.upper_rad[index] ?? Infinity))
  if (at < 0) return undefined
  const limits = [info.lower_rad[at], info.upper_rad[at]].map((each) => each?.toFixed(3)).join(' to ')
  return `${info.joint_names[at]} is limited to ${limits} rad`
}

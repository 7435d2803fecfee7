/** Moving an arm by hand: held or step by step, by joints or at the tool, with mouse, touch or keyboard. */
import { lookup } from '../../document/dict'
import { Button, Flex, Group, SegmentedControl, Slider, Stack, Switch, Text, UnstyledButton } from '@mantine/core'
import { IconKeyboard, IconMinus, IconPlus } from '@tabler/icons-react'
import { useId, useState } from 'react'
import { forgetJogBlock, useDisabledReason, useTeach } from '../../api/teaching'
import type { ArmInfo, ArmLive } from '../../api/types'
import {
  blockWords,
  degrees,
  droppedWords,
  heldWords,
  jogVelocity,
  rollPitchYaw,
  shareOfRange,
  TOOL_AXES,
  toolStep,
  type Frame,
  type Space,
} from '../../document/teaching'
import { HoldButton } from './HoldButton'
import classes from './Jog.module.css'
import { jogKey } from './jogKeys'
import { ToolRow } from './ToolRow'
import { useJog } from './useJog'
import { usePadJog } from './usePadJog'
import { usePreparedJog } from './usePreparedJog'
import { useSteps } from './useSteps'

const BUSY = new Set(['moving', 'guiding', 'direct', 'reflex', 'fault', 'disconnected'])
const STEPS_MM = ['1', '5', '10', '50']
const STEPS_DEG = ['1', '5', '15']
const JOINT_STEP_SPEED = 0.1

/** Why an arm cannot be jogged now. */
function busy(now: ArmLive | undefined): string | undefined {
  if (!now) return 'nothing is known of the arm yet'
  if (!BUSY.has(now.mode)) return undefined
  if (now.mode === 'guiding') return 'it floats: let it hold itself first'
  if (now.mode === 'reflex' || now.mode === 'fault') return now.error || 'it has stopped by itself: recover it first'
  return `it is ${now.mode}${now.activity ? `: ${now.activity}` : ''}`
}

export function JogPanel({ arm }: { readonly arm: ArmInfo }) {
  const [space, setSpace] = useState<Space>('tool')
  const [frame, setFrame] = useState<Frame>('world')
  const [isStepping, setStepping] = useState(false)
  const [share, setShare] = useState(20)
  const [stepMm, setStepMm] = useState('5')
  const [stepDeg, setStepDeg] = useState('5')
  const now = useTeach((s) => lookup(s.now, arm.name))
  const refusal = useTeach((s) => s.refused.jog)
  const dropped = useTeach((s) => (s.dropped?.arm === arm.name ? droppedWords(s.dropped.within_s) : ''))
  const heldBy = useTeach((s) => s.heldBy)
  const steps = useSteps()
  const jog = useJog(arm.name, space, frame)
  const hint = useId()
  const rows = space === 'tool' ? toolRows(now) : jointRows(arm, now)
  const off = useDisabledReason()
  const block = useTeach((s) => s.block)
  const prepared = usePreparedJog(arm.name)
  const obstacle = off ?? (jog.held || steps.isBusy ? undefined : (busy(now) ?? prepared.obstacle))
  const stands =
    block?.robot === arm.name
      ? blockWords(
          block,
          rows.map((row) => row.name),
        )
      : ''
  const [withPad, setWithPad] = useState(false)
  const isPadThere = usePadJog({ isOn: withPad, jog, space, share: share / 100, joints: arm.joint_names.length, obstacle })

  function press(axis: number, direction: 1 | -1): void {
    if (obstacle !== undefined) return
    if (!isStepping) {
      const velocity = jogVelocity(space, axis, (direction * share) / 100, arm.joint_names.length)
      jog.hold(`${rows[axis]?.name ?? ''}${direction}`, () => velocity)
      return
    }
    const turn_rad = (direction * Number(stepDeg) * Math.PI) / 180
    if (space === 'tool') {
      const speed_m_s = Math.max(0.005, (0.25 * share) / 100)
      steps.send(`${arm.name}/step_tool`, { ...toolStep(axis, (direction * Number(stepMm)) / 1000, turn_rad), frame, speed_m_s })
    } else {
      const step_rad = arm.joint_names.map((_, at) => (at === axis ? turn_rad : 0))
      steps.send(`${arm.name}/step_joints`, { step_rad, speed: Math.max(0.01, (JOINT_STEP_SPEED * share) / 100) })
    }
  }

  return (
    <Stack gap="xs">
      <Group gap={6}>
        <SegmentedControl
          size="xs"
          aria-label="Jog target"
          value={space}
          onChange={(value) => {
            setSpace(value)
            forgetJogBlock()
          }}
          data={[
            { value: 'tool', label: 'Tool' },
            { value: 'joints', label: 'Joints' },
          ]}
        />
        <SegmentedControl
          size="xs"
          aria-label="Jog mode"
          value={isStepping ? 'step' : 'hold'}
          onChange={(value) => setStepping(value === 'step')}
          data={[
            { value: 'hold', label: 'Hold to run' },
            { value: 'step', label: 'Step' },
          ]}
        />
        {space === 'tool' && (
          <SegmentedControl
            size="xs"
            aria-label="Along the axes of"
            value={frame}
            onChange={(value) => {
              setFrame(value)
              forgetJogBlock()
            }}
            data={[
              { value: 'world', label: 'World' },
              { value: 'base', label: 'Base' },
              { value: 'tool', label: 'Tool axes' },
            ]}
          />
        )}
      </Group>
      <Group gap="sm" wrap="nowrap" fz="sm">
        <span id={`${hint}-speed`}>Speed</span>
        <Slider
          flex={1}
          size="sm"
          min={1}
          max={100}
          value={share}
          onChange={setShare}
          label={(value) => `${value} %`}
          thumbProps={{ 'aria-labelledby': `${hint}-speed` }}
        />
        <Text component="output" size="sm" w="5em" ta="end" style={{ fontVariantNumeric: 'tabular-nums' }}>
          {space === 'tool' ? `${((0.25 * share * 1000) / 100).toFixed(0)} mm/s` : `${degrees(share / 100).toFixed(0)}°/s`}
        </Text>
      </Group>
      {isStepping && (
        <Group gap={6}>
          {space === 'tool' && (
            <SegmentedControl
              size="xs"
              aria-label="Size of a step"
              value={stepMm}
              onChange={setStepMm}
              data={STEPS_MM.map((value) => ({ value, label: `${value} mm` }))}
            />
          )}
          <SegmentedControl
            size="xs"
            aria-label="Angle of a step"
            value={stepDeg}
            onChange={setStepDeg}
            data={STEPS_DEG.map((value) => ({ value, label: `${value}°` }))}
          />
        </Group>
      )}
      <ul className={`${classes.rows} plain-list`} data-space={space} aria-label={space === 'tool' ? 'Axes of the tool' : 'Joints'}>
        {rows.map((row, axis) => (
          <li key={row.name}>
            <JogKey row={row} axis={axis} direction={-1} jog={jog} press={press} obstacle={obstacle} />
            <Text span size="sm" fw={620}>
              {row.name}
            </Text>
            <Text span size="sm" ta="end" style={{ fontVariantNumeric: 'tabular-nums' }}>
              {row.value}
            </Text>
            {space === 'joints' && <LimitBar share={row.share ?? 0.5} words={row.limits} />}
            <JogKey row={row} axis={axis} direction={1} jog={jog} press={press} obstacle={obstacle} />
          </li>
        ))}
      </ul>
      <UnstyledButton
        className={classes.keyboard}
        data-held={jog.held ? true : undefined}
        aria-describedby={hint}
        onKeyDown={(event) => {
          const pressed = jogKey(space, event.key, event.shiftKey, rows.length)
          if (!pressed) return
          event.preventDefault()
          if (!event.repeat) press(pressed.axis, pressed.direction)
        }}
        onKeyUp={jog.letGo}
        onBlur={jog.letGo}
      >
        <Flex component="span" wrap="wrap" align="center" columnGap="xs" fz="sm">
          <IconKeyboard size={16} aria-hidden />
          <span>Jog with the keyboard</span>
          <Text span size="xs" c="dimmed" id={hint}>
            {space === 'tool'
              ? 'Arrows: X and Y. Page Up and Down: Z. With Shift they turn.'
              : 'Digits move that joint, with Shift in the other direction.'}
          </Text>
        </Flex>
      </UnstyledButton>
      <Switch
        size="sm"
        label="Jog with a gamepad"
        description={padWords(space, withPad, isPadThere)}
        checked={withPad}
        disabled={off !== undefined}
        onChange={(event) => setWithPad(event.currentTarget.checked)}
      />
      <Text size="sm" c="dimmed" mih="2lh" role="status" aria-label="State of jogging">
        {refusal
          ? `${refusal.message}${refusal.hint ? ` – ${refusal.hint}` : ''}`
          : dropped || stands || heldBy || steps.problem || obstacle || (jog.held ? heldWords(now?.mode, now?.activity) : prepared.fault)}
      </Text>
      <ToolRow arm={arm} now={now} steps={steps} obstacle={off} />
      {steps.isBusy && (
        <Button color="red" variant="outline" size="xs" onClick={steps.stop}>
          Stop (Escape)
        </Button>
      )}
    </Stack>
  )
}

function padWords(space: Space, isOn: boolean, isThere: boolean): string {
  if (isOn && !isThere) return 'No gamepad is seen: press a button of it.'
  return space === 'tool'
    ? 'As long as L1 is held. Left stick: X and Y. Right stick: Z. With R1 they turn.'
    : 'As long as L1 is held. Left stick: J1 and J2. Right stick: J3 and J4. With R1 the next joints.'
}

interface Row {
  readonly name: string
  readonly value: string
  readonly share?: number
  readonly limits?: string
}

function toolRows(now: ArmLive | undefined): readonly Row[] {
  const pose = now?.tool_pose ?? []
  const turns = pose.length === 7 ? rollPitchYaw(pose.slice(3)) : []
  return TOOL_AXES.map((name, axis) => {
    const value = axis < 3 ? pose[axis] : turns[axis - 3]
    if (value === undefined) return { name, value: '–' }
    return { name, value: axis < 3 ? `${tenths(value * 1000)} mm` : `${tenths(degrees(value))}°` }
  })
}

function jointRows(arm: ArmInfo, now: ArmLive | undefined): readonly Row[] {
  return arm.joint_names.map((_, at) => {
    const value = now?.joints[at]
    const [lower = 0, upper = 0] = [arm.lower_rad[at], arm.upper_rad[at]]
    const limits = `from ${degrees(lower).toFixed(0)}° to ${degrees(upper).toFixed(0)}°`
    if (value === undefined) return { name: `J${at + 1}`, value: '–', limits }
    return { name: `J${at + 1}`, value: `${tenths(degrees(value))}°`, share: shareOfRange(value, lower, upper), limits }
  })
}

function LimitBar({ share, words }: { readonly share: number; readonly words: string | undefined }) {
  const isNear = share < 0.05 || share > 0.95
  return (
    <span
      className={classes.limit}
      data-near={isNear || undefined}
      role="img"
      aria-label={`${words}${isNear ? ', near a limit' : ''}`}
      title={words}
    >
      <span style={{ left: `${share * 100}%` }} />
    </span>
  )
}

interface JogKeyProps {
  readonly row: Row
  readonly axis: number
  readonly direction: 1 | -1
  readonly jog: ReturnType<typeof useJog>
  readonly press: (axis: number, direction: 1 | -1) => void
  readonly obstacle: string | undefined
}

function JogKey({ row, axis, direction, jog, press, obstacle }: JogKeyProps) {
  const Icon = direction > 0 ? IconPlus : IconMinus
  return (
    <HoldButton
      label={`${row.name} ${direction > 0 ? 'plus' : 'minus'}`}
      isHeld={jog.held === `${row.name}${direction}`}
      obstacle={obstacle}
      onHold={() => press(axis, direction)}
      onLetGo={jog.letGo}
    >
      <Icon size={16} aria-hidden />
    </HoldButton>
  )
}

/** One decimal place, and never a negative zero, whose sign would change while the arm rests. */
function tenths(value: number): string {
  return (Math.round(value * 10) / 10 + 0).toFixed(1)
}

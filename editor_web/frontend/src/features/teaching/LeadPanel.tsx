/** Leading an arm by hand: let it float, record what it does, and push it where there is nobody to do so. */
import { lookup } from '../../document/dict'
import {
  IconArrowDown,
  IconArrowLeft,
  IconArrowRight,
  IconArrowUp,
  IconChevronsDown,
  IconChevronsUp,
  IconFeather,
} from '@tabler/icons-react'
import { Box, Group, Slider, Text } from '@mantine/core'
import { useEffect, useId, useRef, useState } from 'react'
import { wordsOf } from '../../api/client'
import { teach, useDisabledReason, useTeach } from '../../api/teaching'
import type { ArmInfo } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { HoldButton } from './HoldButton'
import classes from './Jog.module.css'
import { Part } from './Part'
import { Refusal } from '../../components/Refusal'

const PUSH_S = 0.3
const REPEAT_MS = 200
const PUSHES = [
  { name: 'forward', force: [1, 0, 0], Icon: IconArrowUp, area: 'up' },
  { name: 'back', force: [-1, 0, 0], Icon: IconArrowDown, area: 'down' },
  { name: 'left', force: [0, 1, 0], Icon: IconArrowLeft, area: 'left' },
  { name: 'right', force: [0, -1, 0], Icon: IconArrowRight, area: 'right' },
  { name: 'up', force: [0, 0, 1], Icon: IconChevronsUp, area: 'top' },
  { name: 'down', force: [0, 0, -1], Icon: IconChevronsDown, area: 'bottom' },
] as const

export function LeadPanel({ arm }: { readonly arm: ArmInfo }) {
  const now = useTeach((s) => lookup(s.now, arm.name))
  const canPush = useTeach((s) => s.canPush)
  const off = useDisabledReason()
  const [problem, setProblem] = useState('')
  const isFloating = now?.mode === 'guiding'

  function float(): void {
    teach.now(arm.name, 'grav_comp', !isFloating).then(
      () => setProblem(''),
      (error: unknown) => setProblem(wordsOf(error)),
    )
  }

  return (
    <Part label="Lead by hand">
      <Group gap="xs">
        <CommandButton
          label={isFloating ? 'Hold position' : 'Float'}
          hint={isFloating ? 'The arm holds its position' : 'The arm compensates gravity and can be guided by hand'}
          icon={<IconFeather size={15} aria-hidden />}
          isPressed={isFloating}
          obstacle={off}
          onPress={float}
        />
        <Text span size="sm" c="dimmed">
          {isFloating ? 'The arm floats: lead it by hand.' : 'The arm holds its position.'}
        </Text>
      </Group>
      {canPush && <PushPad arm={arm.name} obstacle={off ?? (isFloating ? undefined : 'let it float first')} onProblem={setProblem} />}
      <Refusal>{problem}</Refusal>
    </Part>
  )
}

function PushPad({
  arm,
  obstacle,
  onProblem,
}: {
  readonly arm: string
  readonly obstacle: string | undefined
  readonly onProblem: (words: string) => void
}) {
  const [force_n, setForce] = useState(12)
  const [held, setHeld] = useState('')
  const timer = useRef<ReturnType<typeof setInterval>>(undefined)
  const id = useId()

  function letGo(): void {
    clearInterval(timer.current)
    timer.current = undefined
    setHeld('')
  }

  function hold(name: string, direction: readonly number[]): void {
    letGo()
    const [x = 0, y = 0, z = 0] = direction
    const push = () =>
      void teach.push({ arm, force_n: [x * force_n, y * force_n, z * force_n], duration_s: PUSH_S }).then(
        () => onProblem(''),
        (error: unknown) => {
          letGo()
          onProblem(wordsOf(error))
        },
      )
    push()
    timer.current = setInterval(push, REPEAT_MS)
    setHeld(name)
  }

  useEffect(() => () => clearInterval(timer.current), [])

  return (
    <Group align="flex-start">
      <div className={classes.pad} role="group" aria-label="Push at the tool">
        {PUSHES.map(({ name, force, Icon, area }) => (
          <span key={name} style={{ gridArea: area }}>
            <HoldButton label={`Push ${name}`} isHeld={held === name} obstacle={obstacle} onHold={() => hold(name, force)} onLetGo={letGo}>
              <Icon size={17} aria-hidden />
            </HoldButton>
          </span>
        ))}
      </div>
      <Box flex="1 1 12em">
        <Text span size="sm" id={id}>
          Push with {force_n} N
        </Text>
        <Slider size="sm" min={2} max={40} value={force_n} onChange={setForce} label={null} thumbProps={{ 'aria-labelledby': id }} />
        <Text size="sm" c="dimmed" mt="xs">
          Instead of a hand, the arrows push the tool of the simulated arm along the axes of the world.
        </Text>
      </Box>
    </Group>
  )
}

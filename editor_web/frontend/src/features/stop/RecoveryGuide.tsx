/** The recovery guide: the steps from a stopped cell back to runs, each with its state, in the order that makes sense. */
import { Accordion, CloseButton, Group, Stack, Text, Title, VisuallyHidden } from '@mantine/core'
import { IconCircle, IconMinus } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { useLive } from '../../api/live'
import type { DeviceRecovery } from '../../api/types'
import { nextStep, STATE_WORDS, stepsOf, type RecoveryStep, type StepId, type StepState } from '../../document/recovery'
import { StatusIcon } from '../../components/StatusIcon'
import { EnableStep } from './EnableStep'
import { HomeStep, JogStep, PartsStep, ResetStep, RestStep } from './ArmSteps'
import { openGuide } from './guide'
import { ReleaseStep, RunsStep } from './RunSteps'
import type { StepProps } from './useStep'

export interface RecoveryGuideProps {
  /** Jogs an arm in place. */
  readonly renderJog: (arm: string) => ReactNode
  /** Enables a real device, by its address on the bus. */
  readonly renderEnable: (device: DeviceRecovery) => ReactNode
  readonly onTeach: () => void
  readonly onRun: (id: string) => void
  readonly onBehavior: (id: string) => void
}

function StateIcon({ state }: { readonly state: StepState }) {
  if (state === 'done') return <StatusIcon status="done" size={18} />
  if (state === 'problem') return <StatusIcon status="failed" size={18} />
  return state === 'open' ? (
    <IconCircle size={18} color="var(--active)" aria-hidden />
  ) : (
    <IconMinus size={18} color="var(--quiet)" aria-hidden />
  )
}

export function RecoveryGuide(props: RecoveryGuideProps) {
  const stop = useLive((s) => s.stop)
  const mayOperate = useLive((s) => s.role === 'operator')
  const [toggled, setToggled] = useState<Partial<Record<StepId, boolean>>>({})
  if (!stop) return null
  const steps = stepsOf(stop)
  const next = nextStep(steps)
  const isOpened = (step: RecoveryStep) => toggled[step.id] ?? (step.state === 'open' || step.state === 'problem')
  const opened = steps.filter(isOpened).map((step) => step.id)
  return (
    <Stack
      component="section"
      gap="sm"
      h="100%"
      px="md"
      py="sm"
      bg="var(--surface)"
      style={{ overflowY: 'auto' }}
      aria-label="Recovery guide"
    >
      <Group component="header" justify="space-between">
        <Title order={2} size="h4">
          Recovery guide
        </Title>
        <CloseButton aria-label="Close the recovery guide" onClick={() => openGuide(false)} />
      </Group>
      <Text size="sm" c="dimmed">
        {mayOperate
          ? 'From the stopped cell back to runs. Nothing moves unless you press it here or jog.'
          : 'You see the steps; somebody who is logged in as operator does them.'}
      </Text>
      <Accordion
        multiple
        order={3}
        variant="separated"
        transitionDuration={0}
        value={opened}
        onChange={(now) =>
          setToggled(
            Object.fromEntries(
              steps
                .filter((step) => isOpened(step) !== now.includes(step.id) || toggled[step.id] !== undefined)
                .map((step) => [step.id, now.includes(step.id)]),
            ),
          )
        }
      >
        {steps.map((step, at) => (
          <Accordion.Item
            key={step.id}
            value={step.id}
            data-state={step.state}
            data-next={step.id === next || undefined}
            bg="var(--raised)"
            style={{ borderColor: step.state === 'problem' ? 'var(--failed)' : step.id === next ? 'var(--active)' : 'var(--line)' }}
          >
            <Accordion.Control icon={<StateIcon state={step.state} />}>
              <Text span inherit display="block" fw={600}>
                {at + 1}. {step.title}
              </Text>
              <Text span size="xs" display="block" c="var(--quiet)" style={{ overflowWrap: 'anywhere' }}>
                <VisuallyHidden component="span">{STATE_WORDS[step.state]}: </VisuallyHidden>
                {step.words}
              </Text>
            </Accordion.Control>
            <Accordion.Panel>
              <StepBody id={step.id} stop={stop} mayOperate={mayOperate} {...props} />
            </Accordion.Panel>
          </Accordion.Item>
        ))}
      </Accordion>
    </Stack>
  )
}

function StepBody({
  id,
  stop,
  mayOperate,
  renderJog,
  renderEnable,
  onTeach,
  onRun,
  onBehavior,
}: StepProps & RecoveryGuideProps & { readonly id: StepId }) {
  switch (id) {
    case 'rest':
      return <RestStep stop={stop} />
    case 'enable':
      return <EnableStep stop={stop} renderEnable={renderEnable} />
    case 'parts':
      return <PartsStep stop={stop} mayOperate={mayOperate} />
    case 'jog':
      return <JogStep stop={stop} mayOperate={mayOperate} renderJog={renderJog} onTeach={onTeach} />
    case 'home':
      return <HomeStep stop={stop} mayOperate={mayOperate} />
    case 'reset':
      return <ResetStep stop={stop} mayOperate={mayOperate} />
    case 'release':
      return <ReleaseStep stop={stop} mayOperate={mayOperate} />
    case 'runs':
      return <RunsStep stop={stop} mayOperate={mayOperate} onRun={onRun} onBehavior={onBehavior} />
  }
}

/** The steps of the recovery that are about arms, what they hold and the parts. */
import { Button, Group, Paper, Text } from '@mantine/core'
import { useState, type ReactNode } from 'react'
import { Refusal } from '../../components/Refusal'
import { recovery } from '../../api/recovery'
import type { ArmRecovery, CellStop } from '../../api/types'
import { deviceWords, partWords } from '../../document/recovery'
import { Confirm } from './Confirm'
import { useStep, type StepCommand, type StepProps } from './useStep'

export function RestStep({ stop }: { readonly stop: CellStop }) {
  return (
    <>
      <ul className="plain-list" aria-label="What the stop did">
        {stop.devices.map((device) => (
          <Text
            component="li"
            key={device.name}
            size="sm"
            c={device.status === 'failed' ? 'var(--failed)' : 'inherit'}
            style={{ overflowWrap: 'anywhere' }}
          >
            <strong>{device.name}</strong> {deviceWords(device)}
          </Text>
        ))}
      </ul>
      {stop.devices.some((device) => device.status === 'failed') && (
        <Text size="sm">
          Press the emergency stop if it still moves. Else connect the cell again if it is lost, and stop the cell once more.
        </Text>
      )}
    </>
  )
}

export function PartsStep({ stop, mayOperate }: StepProps) {
  const command = useStep()
  const holding = stop.arms.filter((arm) => arm.part !== '')
  if (holding.length === 0) return <Text size="sm">No tool reports that it holds something. Look at the arms.</Text>
  return (
    <>
      {holding.map((arm) => (
        <ArmRow key={arm.name} arm={arm} words={`holds ${partWords(arm.part)}${arm.kept ? ', and keeps it' : ''}`}>
          {!arm.kept && (
            <Button
              size="xs"
              disabled={!canAct(stop, mayOperate, command)}
              onClick={() => command.send(`keep ${arm.name}`, () => recovery.keep(arm.name))}
            >
              Keep
            </Button>
          )}
          <Confirm
            label="Release"
            title={`Let ${arm.name} release ${partWords(arm.part)}?`}
            disabled={!canAct(stop, mayOperate, command) || !arm.can_release}
            loading={command.busy === `release ${arm.name}`}
            onConfirm={() => command.send(`release ${arm.name}`, () => recovery.releasePart(arm.name))}
          >
            <Text size="sm">
              The tool of {arm.name} opens, and the part falls from where it is now. Jog it down first if it must not fall, and keep your
              hands away.
            </Text>
          </Confirm>
        </ArmRow>
      ))}
      <Text size="sm" c="dimmed">
        A part that is kept belongs to its arm: it moves with it and does not block it.
      </Text>
      <Refusal>{command.problem}</Refusal>
    </>
  )
}

interface JogStepProps extends StepProps {
  readonly renderJog: (arm: string) => ReactNode
  readonly onTeach: () => void
}

export function JogStep({ stop, mayOperate, renderJog, onTeach }: JogStepProps) {
  const [chosen, setChosen] = useState('')
  const isChosen = stop.arms.some((arm) => arm.name === chosen)
  return (
    <>
      {stop.arms.map((arm) => (
        <ArmRow key={arm.name} arm={arm} words={arm.has_moved ? 'has moved since the stop' : 'is where it was stopped'}>
          <Button
            size="xs"
            variant="default"
            aria-expanded={chosen === arm.name}
            disabled={!mayOperate || stop.phase === 'stopping'}
            onClick={() => setChosen(chosen === arm.name ? '' : arm.name)}
          >
            {chosen === arm.name ? 'Put the jog panel away' : `Jog ${arm.name}`}
          </Button>
        </ArmRow>
      ))}
      {isChosen && (
        <Paper withBorder p="xs" my="xs">
          {renderJog(chosen)}
        </Paper>
      )}
      <Text size="sm" c="dimmed">
        An arm moves only while you hold a key. What it holds does not block it.{' '}
        <Button size="compact-xs" variant="subtle" onClick={onTeach}>
          Open the page Teach
        </Button>
      </Text>
    </>
  )
}

export function HomeStep({ stop, mayOperate }: StepProps) {
  const command = useStep()
  return (
    <>
      {stop.arms.map((arm) => (
        <ArmRow key={arm.name} arm={arm} words={homeWords(arm)} problem={command.busy || command.problem ? '' : arm.problem}>
          {command.busy === `home ${arm.name}` && (
            <Button size="xs" variant="default" onClick={command.stop}>
              Stop this motion
            </Button>
          )}
          {arm.home !== '' && !arm.at_home && (
            <Confirm
              label="Go home"
              title={`Move ${arm.name} home?`}
              disabled={!canAct(stop, mayOperate, command)}
              loading={command.busy === `home ${arm.name}`}
              onConfirm={() => command.send(`home ${arm.name}`, (signal) => recovery.goHome(arm.name, signal))}
            >
              <Text size="sm">
                {arm.name} moves slowly to {arm.home}, around the obstacles that the cell knows{arm.part && `, with ${partWords(arm.part)}`}
                . Keep clear. It stops when you press Stop, or close this guide.
              </Text>
            </Confirm>
          )}
        </ArmRow>
      ))}
      <Refusal>{command.problem}</Refusal>
    </>
  )
}

export function ResetStep({ stop, mayOperate }: StepProps) {
  const command = useStep()
  if (stop.parts === 'absent') return <Text size="sm">This cell has no simulated parts: put real ones back by hand.</Text>
  return (
    <>
      <Group gap="xs" justify="space-between">
        <Text size="sm">All parts of the simulation go to their initial poses, also those that an arm holds. No arm moves.</Text>
        <Button
          size="xs"
          variant="default"
          disabled={!canAct(stop, mayOperate, command)}
          loading={command.busy !== ''}
          onClick={() => command.send('reset', () => recovery.resetParts())}
        >
          Reset parts
        </Button>
      </Group>
      <Refusal>{command.problem}</Refusal>
    </>
  )
}

function homeWords(arm: ArmRecovery): string {
  if (arm.home === '') return `has no home: save its joints as the entry ${arm.home_names.join(' or ')}, on the page Teach`
  return arm.at_home ? `is at home (${arm.home})` : `is not at home (${arm.home})`
}

interface ArmRowProps {
  readonly arm: ArmRecovery
  readonly words: string
  /** Why the last step with it failed. */
  readonly problem?: string
  readonly children: ReactNode
}

function ArmRow({ arm, words, problem = '', children }: ArmRowProps) {
  return (
    <StepRow label={arm.name} tools={children}>
      <strong>{arm.name}</strong> {words}
      {problem && (
        <Text span display="block" size="sm" c="var(--failed)">
          Failed: {problem}
        </Text>
      )}
    </StepRow>
  )
}

interface StepRowProps {
  readonly label: string
  readonly tools: ReactNode
  readonly children: ReactNode
}

/** An arm or a run of a step, and what can be done with it. */
export function StepRow({ label, tools, children }: StepRowProps) {
  return (
    <Group justify="space-between" gap="xs" py="xs" fz="sm" style={{ overflowWrap: 'anywhere' }} role="group" aria-label={label}>
      <span>{children}</span>
      <Group component="span" gap="xs">
        {tools}
      </Group>
    </Group>
  )
}

/** Steps that move are those of a stopped cell. */
function canAct(stop: CellStop, mayOperate: boolean, command: StepCommand): boolean {
  return mayOperate && stop.phase === 'stopped' && command.busy === ''
}

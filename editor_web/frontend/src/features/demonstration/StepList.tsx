/** The chosen steps in their order: what each is for, and what a grasp takes. */
import { ActionIcon, Flex, Group, NativeSelect, Paper, Text, Title } from '@mantine/core'
import { IconArrowDown, IconArrowUp, IconX } from '@tabler/icons-react'
import type { TaughtStep } from '../../api/types'
import { KIND_WORDS, ROLE_WORDS, rolesOf, takes, type Role, type Step } from '../../document/demonstration'
import { reordered } from '../../document/reorder'
import classes from './Demonstration.module.css'
import { RowTool } from '../../components/RowTool'
import { EntryIcon } from './EntryChoice'

export interface StepListProps {
  readonly steps: readonly Step[]
  /** As the proposal of these steps decided; missing while it is being made. */
  readonly decided: readonly TaughtStep[]
  readonly parts: readonly string[]
  readonly onChange: (steps: readonly Step[]) => void
}

export function StepList({ steps, decided, parts, onChange }: StepListProps) {
  function changed(key: number, change: Partial<Step>): void {
    onChange(steps.map((step) => (step.key === key ? { ...step, ...change } : step)))
  }
  return (
    <Flex component="section" direction="column" gap="xs" aria-label="Steps">
      <Title order={3} size="sm">
        Steps in their order
      </Title>
      {steps.length === 0 && (
        <Text size="sm" c="dimmed">
          Add taught entries, in the order of execution.
        </Text>
      )}
      <Flex component="ol" direction="column" gap={6} className={`${classes.scroll} plain-list`}>
        {steps.map((step, index) => {
          const known = fitting(decided, steps) ? decided[index] : undefined
          const words = step.kind === 'action' ? `${ROLE_WORDS[step.name === 'close' ? 'close' : 'open']} gripper` : step.name
          return (
            <Paper key={step.key} component="li" withBorder bg="var(--raised)" px="xs" py={4} aria-label={`Step ${index + 1}: ${words}`}>
              <Group gap="xs" wrap="nowrap">
                <Text span size="xs" c="dimmed" miw="1.2em" aria-hidden>
                  {index + 1}
                </Text>
                <EntryIcon kind={step.kind} />
                <Text span size="sm" truncate flex={1}>
                  {words}
                </Text>
                {step.kind !== 'action' && (
                  <Text span size="xs" c="dimmed" visibleFrom="md">
                    {KIND_WORDS[step.kind]}
                  </Text>
                )}
                {rolesOf(step.kind).length > 1 && step.kind !== 'action' && (
                  <RoleChoice step={step} guessed={known?.role ?? undefined} onChange={(role) => changed(step.key, { role })} />
                )}
                <ActionIcon.Group>
                  <RowTool label="Earlier" isOff={index === 0} onPress={() => onChange(reordered(steps, index, -1))}>
                    <IconArrowUp size={14} aria-hidden />
                  </RowTool>
                  <RowTool label="Later" isOff={index === steps.length - 1} onPress={() => onChange(reordered(steps, index, 1))}>
                    <IconArrowDown size={14} aria-hidden />
                  </RowTool>
                  <RowTool label="Remove" onPress={() => onChange(steps.filter((each) => each.key !== step.key))}>
                    <IconX size={14} aria-hidden />
                  </RowTool>
                </ActionIcon.Group>
              </Group>
              {known && takes(known, decided[index - 1]) && (
                <PartChoice part={step.part ?? known.part ?? ''} parts={parts} onChange={(part) => changed(step.key, { part })} />
              )}
            </Paper>
          )
        })}
      </Flex>
    </Flex>
  )
}

/** Whether what was decided is about these steps, and not about those before a change. */
function fitting(decided: readonly TaughtStep[], steps: readonly Step[]): boolean {
  return decided.length === steps.length && decided.every((each, index) => each.name === steps[index]?.name)
}

interface RoleChoiceProps {
  readonly step: Step
  readonly guessed: Role | undefined
  readonly onChange: (role: Role) => void
}

function RoleChoice({ step, guessed, onChange }: RoleChoiceProps) {
  return (
    <NativeSelect
      size="xs"
      styles={{ input: { borderStyle: step.role ? 'solid' : 'dashed' } }}
      aria-label={`What ${step.name} is for`}
      title={step.role ? undefined : 'Guessed from order, names and places'}
      value={step.role ?? guessed ?? ''}
      data={[
        ...((step.role ?? guessed) === undefined ? [{ value: '', label: '…' }] : []),
        ...rolesOf(step.kind).map((role) => ({ value: role, label: ROLE_WORDS[role] })),
      ]}
      onChange={(event) => onChange(event.currentTarget.value as Role)}
    />
  )
}

interface PartChoiceProps {
  readonly part: string
  readonly parts: readonly string[]
  readonly onChange: (part: string) => void
}

function PartChoice({ part, parts, onChange }: PartChoiceProps) {
  return (
    <Group gap="xs" mt={4} pl="2.5rem">
      <Text span size="xs" c="dimmed">
        takes
      </Text>
      <NativeSelect
        size="xs"
        aria-label="Grasped part"
        value={part}
        data={[{ value: '', label: 'a part without a name' }, ...new Set([...parts, ...(part ? [part] : [])])]}
        onChange={(event) => onChange(event.currentTarget.value)}
      />
    </Group>
  )
}

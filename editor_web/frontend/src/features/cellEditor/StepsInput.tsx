/** The steps towards a position of a device: outputs are set, a time passes, or sensors are awaited. */
import { ActionIcon, Button, Group, NativeSelect, Stack, TextInput } from '@mantine/core'
import { IconPlus, IconX } from '@tabler/icons-react'
import { DURATION, listOf } from '../../document/cellDevices'
import { wordsOf, type Field } from '../../document/cellFields'
import { lookup, type Dict } from '../../document/dict'
import { LevelsInput } from './LevelsInput'

interface StepsInputProps {
  readonly field: Field & { readonly kind: 'steps' }
  readonly value: unknown
  readonly onChange: (value: unknown) => void
}

const KINDS = [
  { value: 'set', label: 'Set outputs' },
  { value: 'pause', label: 'Pause' },
  { value: 'wait_for', label: 'Wait for sensors' },
] as const
const FIRST: Dict<Dict<unknown>> = { set: { set: {} }, pause: { pause: '500 ms' }, wait_for: { wait_for: {}, within: '2 s' } }

export function StepsInput({ field, value, onChange }: StepsInputProps) {
  const steps = listOf(value)
  const change = (at: number, step: Dict<unknown> | undefined) =>
    onChange(steps.flatMap((each, index) => (index === at ? (step === undefined ? [] : [step]) : [each])))
  return (
    <Stack gap={6} role="group" aria-label={field.label}>
      {steps.map((step, at) => (
        // The steps have no names: their order is what they are.
        <Group key={at} gap="xs" wrap="nowrap" align="start">
          <Stack gap={4} flex={1} miw={0}>
            <NativeSelect
              size="xs"
              aria-label={`Step ${at + 1}`}
              data={[...KINDS]}
              value={kindOf(step)}
              onChange={(event) => change(at, lookup(FIRST, event.currentTarget.value))}
            />
            <StepFields field={field} step={step} at={at} onChange={(next) => change(at, next)} />
          </Stack>
          <ActionIcon
            variant="subtle"
            color="gray"
            aria-label={`Remove step ${at + 1}`}
            disabled={steps.length === 1}
            onClick={() => change(at, undefined)}
          >
            <IconX size={14} aria-hidden />
          </ActionIcon>
        </Group>
      ))}
      <Button
        size="compact-xs"
        variant="default"
        w="fit-content"
        leftSection={<IconPlus size={13} aria-hidden />}
        onClick={() => onChange([...steps, FIRST['pause']])}
      >
        Step
      </Button>
    </Stack>
  )
}

function kindOf(step: Dict<unknown>): string {
  return KINDS.find((each) => lookup(step, each.value) !== undefined && lookup(step, each.value) !== null)?.value ?? 'set'
}

function StepFields({
  field,
  step,
  at,
  onChange,
}: {
  readonly field: Field & { readonly kind: 'steps' }
  readonly step: Dict<unknown>
  readonly at: number
  readonly onChange: (step: Dict<unknown>) => void
}) {
  switch (kindOf(step)) {
    case 'pause':
      return <DurationInput label={`Pause of step ${at + 1}`} value={lookup(step, 'pause')} onChange={(pause) => onChange({ pause })} />
    case 'wait_for':
      return (
        <>
          <LevelsInput
            label={`Sensors of step ${at + 1}`}
            choices={field.sensors}
            isOpen={false}
            value={lookup(step, 'wait_for')}
            onChange={(levels) => onChange({ ...step, wait_for: levels ?? {} })}
          />
          <DurationInput
            label={`Within, of step ${at + 1}`}
            value={lookup(step, 'within') ?? '2 s'}
            onChange={(within) => onChange({ ...step, within })}
          />
        </>
      )
    default:
      return (
        <LevelsInput
          label={`Outputs of step ${at + 1}`}
          choices={field.outputs}
          isOpen
          value={lookup(step, 'set')}
          onChange={(levels) => onChange({ set: levels ?? {} })}
        />
      )
  }
}

function DurationInput({
  label,
  value,
  onChange,
}: {
  readonly label: string
  readonly value: unknown
  readonly onChange: (value: string) => void
}) {
  const text = wordsOf(value)
  return (
    <TextInput
      size="xs"
      aria-label={label}
      value={text}
      error={!DURATION.test(text)}
      onChange={(event) => onChange(event.currentTarget.value)}
    />
  )
}

/** How the run is watched over: autonomy, operator, where it pauses, what happens when the operator is lost. */
import { Group, NumberInput, Select, Stack, Switch, Text } from '@mantine/core'
import { LEVEL_WORDS, LEVELS } from '../../document/commands'
import { withAutonomy, type LossPolicy, type Supervision } from '../../document/supervision'

const LOSSES = [
  { value: 'hold', label: 'pause the run' },
  { value: 'continue', label: 'let it go on without questions' },
  { value: 'stop', label: 'stop the run' },
]

export interface StartOptionsProps {
  readonly supervision: Supervision
  readonly onChange: (supervision: Supervision) => void
  readonly hasBreakpoints: boolean
}

export function StartOptions({ supervision, onChange, hasBreakpoints }: StartOptionsProps) {
  const set = (change: Partial<Supervision>) => onChange({ ...supervision, ...change })
  return (
    <Stack gap="sm">
      <Select
        size="sm"
        label="Autonomy at the start"
        description={`While the run has an operator, ${LEVEL_WORDS[supervision.autonomy]}`}
        data={[...LEVELS]}
        value={supervision.autonomy}
        allowDeselect={false}
        onChange={(level) => onChange(withAutonomy(supervision, level ?? 'full'))}
      />
      <Switch
        size="sm"
        label="Take control of it from this page"
        description="Its questions come here; closing this page is then an operator lost"
        checked={supervision.operates}
        onChange={(event) => set({ operates: event.currentTarget.checked })}
      />
      <Switch
        size="sm"
        label="Demand an operator"
        description="It asks even without an operator"
        checked={supervision.demandsOperator}
        onChange={(event) => set({ demandsOperator: event.currentTarget.checked })}
      />
      <Switch
        size="sm"
        label="Begin paused"
        checked={supervision.startsPaused}
        onChange={(event) => set({ startsPaused: event.currentTarget.checked })}
      />
      <Switch
        size="sm"
        label="Pause at the breakpoints"
        description={hasBreakpoints ? undefined : 'None is set'}
        checked={supervision.usesBreakpoints}
        onChange={(event) => set({ usesBreakpoints: event.currentTarget.checked })}
      />
      <Group gap="xs" align="flex-end" wrap="nowrap">
        <Select
          size="sm"
          flex={1}
          label="When the operator is lost"
          data={LOSSES}
          value={supervision.lossPolicy}
          allowDeselect={false}
          onChange={(policy) => set({ lossPolicy: (policy ?? 'hold') as LossPolicy })}
        />
        <NumberInput
          size="sm"
          w={90}
          label="After"
          min={0}
          value={supervision.lossTimeoutS}
          onChange={(value) => set({ lossTimeoutS: Math.max(0, Number(value) || 0) })}
          rightSection={
            <Text span size="xs" c="var(--quiet)">
              s
            </Text>
          }
        />
      </Group>
    </Stack>
  )
}

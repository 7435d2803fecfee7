/** Numbers of a value, each with its name and unit. */
import { Group, NumberInput, Text } from '@mantine/core'

export interface VectorFieldsProps {
  readonly label: string
  readonly names: readonly string[]
  readonly unit: string
  readonly values: readonly number[]
  readonly digits?: number
  readonly minimum?: number
  readonly onChange: (values: number[]) => void
}

export function VectorFields({ label, names, unit, values, digits = 4, minimum, onChange }: VectorFieldsProps) {
  return (
    <Group gap={6} wrap="nowrap" role="group" aria-label={label}>
      <Text size="xs" w="6.5rem" flex="none">
        {label}
      </Text>
      {names.map((name, at) => (
        <NumberInput
          key={name}
          size="xs"
          flex={1}
          miw={0}
          hideControls
          aria-label={`${label} ${name}`}
          leftSection={
            <Text span size="xs" c="dimmed">
              {name}
            </Text>
          }
          leftSectionWidth={name.length > 1 ? 42 : 24}
          decimalScale={digits}
          {...(minimum === undefined ? {} : { min: minimum })}
          value={Number((values[at] ?? 0).toFixed(digits))}
          onChange={(value) => typeof value === 'number' && onChange(names.map((_, each) => (each === at ? value : (values[each] ?? 0))))}
        />
      ))}
      <Text size="xs" c="dimmed" w="1.8rem" flex="none">
        {unit}
      </Text>
    </Group>
  )
}

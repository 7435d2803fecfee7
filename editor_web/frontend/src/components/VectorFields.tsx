/** Numbers of a value, each with its name and unit. */
import { Group, NumberInput, Text } from '@mantine/core'
import { useState } from 'react'

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
        <NumberField
          key={name}
          label={`${label} ${name}`}
          name={name}
          digits={digits}
          minimum={minimum}
          value={values[at] ?? 0}
          onChange={(value) => onChange(names.map((_, each) => (each === at ? value : (values[each] ?? 0))))}
        />
      ))}
      <Text size="xs" c="dimmed" w="1.8rem" flex="none">
        {unit}
      </Text>
    </Group>
  )
}

interface NumberFieldProps {
  readonly label: string
  readonly name: string
  readonly digits: number
  readonly minimum: number | undefined
  readonly value: number
  readonly onChange: (value: number) => void
}

function NumberField({ label, name, digits, minimum, value, onChange }: NumberFieldProps) {
  // As it was typed: `1.0` is a number already, and may become `1.05`.
  const [typed, setTyped] = useState('')
  const rounded = Number(value.toFixed(digits))
  return (
    <NumberInput
      size="xs"
      flex={1}
      miw={0}
      hideControls
      aria-label={label}
      leftSection={
        <Text span size="xs" c="dimmed">
          {name}
        </Text>
      }
      leftSectionWidth={name.length > 1 ? 12 + 6 * name.length : 24}
      decimalScale={digits}
      {...(minimum === undefined ? {} : { min: minimum })}
      value={typed !== '' && Number(typed) === rounded ? typed : rounded}
      onChange={(next) => {
        const text = String(next)
        if (text.trim() === '' || !Number.isFinite(Number(text))) return
        setTyped(text)
        onChange(Number(text))
      }}
    />
  )
}

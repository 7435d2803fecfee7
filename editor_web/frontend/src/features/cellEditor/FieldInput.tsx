/** One field of an item: a choice, numbers with their unit, a colour or a switch. */
import { ColorInput, NativeSelect, Switch } from '@mantine/core'
import { VectorFields } from '../../components/VectorFields'
import { numbersOf, shownNumbers, writtenNumbers, type Field } from '../../document/cellEditing'

interface FieldInputProps {
  readonly field: Field
  readonly value: unknown
  readonly onChange: (value: unknown) => void
}

export function FieldInput({ field, value, onChange }: FieldInputProps) {
  switch (field.kind) {
    case 'choice': {
      const now = typeof value === 'string' ? value : typeof field.usual === 'string' ? field.usual : ''
      return (
        <NativeSelect
          size="xs"
          label={field.label}
          value={now}
          data={[...new Set([...(field.choices.includes(now) ? [] : [now]), ...field.choices])]}
          onChange={(event) => onChange(event.currentTarget.value === field.none ? undefined : event.currentTarget.value)}
        />
      )
    }
    case 'numbers':
      return (
        <VectorFields
          label={field.label}
          names={field.names}
          unit={field.unit}
          digits={field.isAngle ? 4 : 6}
          {...(field.minimum === undefined ? {} : { minimum: field.minimum })}
          values={shownNumbers(field, value)}
          onChange={(shown) => onChange(writtenNumbers(field, value, shown))}
        />
      )
    case 'colour':
      return (
        <ColorInput
          size="xs"
          label={field.label}
          placeholder="As usual"
          withEyeDropper={false}
          value={typeof value === 'string' ? value : ''}
          onChange={(colour) => onChange(colour || undefined)}
        />
      )
    case 'switch':
      return (
        <Switch
          size="xs"
          label={field.label}
          checked={(value ?? field.usual) === true}
          onChange={(event) => onChange(event.currentTarget.checked === field.usual ? undefined : event.currentTarget.checked)}
        />
      )
  }
}

/** Whether numbers are as many as their names, and above their minimum. */
export function fieldFault(field: Field, value: unknown): string | undefined {
  if (field.kind !== 'numbers' || field.minimum === undefined) return undefined
  return numbersOf(value ?? field.usual).some((each) => each <= 0) ? `${field.label} is above 0` : undefined
}

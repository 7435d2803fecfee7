/** One field of an item: a choice, numbers with their unit, a text, a colour, a switch, or what a device does. */
import { Checkbox, ColorInput, NativeSelect, NumberInput, Switch, Text, TextInput } from '@mantine/core'
import { VectorFields } from '../../components/VectorFields'
import { numbersOf, shownNumbers, wordsOf, writtenNumbers, type Field } from '../../document/cellFields'
import { InterlocksInput } from './InterlocksInput'
import { LevelsInput } from './LevelsInput'
import { StepsInput } from './StepsInput'

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
      return field.absent === undefined ? (
        <VectorFields
          label={field.label}
          names={field.names}
          unit={field.unit}
          digits={field.isAngle ? 4 : 6}
          {...(field.minimum === undefined ? {} : { minimum: field.minimum })}
          values={shownNumbers(field, value)}
          onChange={(shown) => onChange(writtenNumbers(field, value, shown))}
        />
      ) : (
        <LimitInput field={field} absent={field.absent} value={value} onChange={onChange} />
      )
    case 'text':
      return (
        <TextInput
          size="xs"
          label={field.label}
          placeholder={field.hint ?? ''}
          value={wordsOf(value)}
          error={fieldFault(field, value) !== undefined}
          onChange={(event) => onChange(event.currentTarget.value || undefined)}
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
    case 'names':
      return <NamesInput field={field} value={value} onChange={onChange} />
    case 'levels':
      return <LevelsInput label={field.label} choices={field.choices} isOpen={field.isOpen} value={value} onChange={onChange} />
    case 'steps':
      return <StepsInput field={field} value={value} onChange={onChange} />
    case 'interlocks':
      return <InterlocksInput field={field} value={value} onChange={onChange} />
  }
}

/** A number that may be missing. */
function LimitInput({
  field,
  absent,
  value,
  onChange,
}: FieldInputProps & { readonly field: Field & { readonly kind: 'numbers' }; readonly absent: string }) {
  return (
    <NumberInput
      size="xs"
      hideControls
      label={`${field.label}${field.unit && ` (${field.unit})`}`}
      placeholder={absent}
      decimalScale={field.isAngle ? 4 : 6}
      {...(field.minimum === undefined ? {} : { min: field.minimum })}
      value={value === undefined || value === null ? '' : (shownNumbers(field, value)[0] ?? '')}
      onChange={(shown) => onChange(shown === '' ? undefined : writtenNumbers(field, value, [Number(shown)]))}
    />
  )
}

function NamesInput({ field, value, onChange }: FieldInputProps & { readonly field: Field & { readonly kind: 'names' } }) {
  const chosen = Array.isArray(value) ? value.map(String) : []
  return (
    <details>
      <Text component="summary" size="xs">{`${field.label}: ${chosen.join(', ') || 'none'}`}</Text>
      {[...new Set([...field.choices, ...chosen])].map((name) => (
        <Checkbox
          key={name}
          size="xs"
          mt={4}
          label={name}
          checked={chosen.includes(name)}
          onChange={({ currentTarget: { checked } }) => {
            const next = checked ? [...chosen, name] : chosen.filter((each) => each !== name)
            onChange(next.length === 0 ? undefined : next)
          }}
        />
      ))}
    </details>
  )
}

/** Whether numbers are as many as their names, and above their minimum; whether a text is of its kind. */
export function fieldFault(field: Field, value: unknown): string | undefined {
  if (field.kind === 'text') {
    const text = wordsOf(value)
    return field.pattern && text !== '' && !field.pattern.test(text) ? `${field.label}: ${field.hint ?? ''}` : undefined
  }
  if (field.kind !== 'numbers' || field.minimum === undefined) return undefined
  return numbersOf(value ?? field.usual).some((each) => each <= 0) ? `${field.label} is above 0` : undefined
}

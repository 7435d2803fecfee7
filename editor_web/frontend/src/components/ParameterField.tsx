/** One parameter as the input that fits its kind. */
import { Autocomplete, NumberInput, Select, Switch, Text, Textarea, TextInput } from '@mantine/core'
import { rangeText, type Field } from '../document/schema'

export interface ParameterFieldProps {
  readonly field: Field
  readonly value: unknown
  readonly problem: string | undefined
  /** Names to choose from; another one can be typed. */
  readonly offers?: readonly string[] | undefined
  readonly onChange: (value: unknown) => void
}

export function ParameterField({ field, value, problem, offers, onChange }: ParameterFieldProps) {
  const range = rangeText(field)
  const common = {
    size: 'sm' as const,
    name: field.name,
    label: (
      <>
        {field.label}
        {(range || field.unit) && (
          <Text span ml="2xs" size="xs" c="var(--quiet)">
            {[range, field.unit].filter(Boolean).join(' ')}
          </Text>
        )}
      </>
    ),
    description: field.description || undefined,
    withAsterisk: field.required,
    error: problem,
  }
  switch (field.kind) {
    case 'number':
    case 'integer':
      return (
        <NumberInput
          {...common}
          value={value as string | number}
          onChange={onChange}
          allowDecimal={field.kind === 'number'}
          clampBehavior="none"
          step={stepOf(field)}
          rightSection={
            field.unit ? (
              <Text span size="xs" c="var(--quiet)">
                {field.unit}
              </Text>
            ) : undefined
          }
          rightSectionWidth={field.unit ? 44 : undefined}
        />
      )
    case 'boolean':
      return (
        <Switch
          size="sm"
          name={field.name}
          label={field.label}
          description={field.description || undefined}
          error={problem}
          checked={value === true}
          onChange={(event) => onChange(event.currentTarget.checked)}
        />
      )
    case 'choice':
      return (
        <Select
          {...common}
          data={field.choices}
          value={value === '' ? null : String(value)}
          onChange={(chosen) => onChange(chosen ?? '')}
          allowDeselect={!field.required}
        />
      )
    case 'json':
      return (
        <Textarea
          {...common}
          styles={{ input: { fontFamily: 'var(--mantine-font-family-monospace)' } }}
          autosize
          minRows={2}
          value={String(value)}
          onChange={(event) => onChange(event.currentTarget.value)}
        />
      )
    case 'text':
      if (offers)
        return (
          <Autocomplete
            {...common}
            data={[...offers]}
            value={String(value)}
            onChange={onChange}
            // All of them are shown beside one that is chosen.
            filter={({ options, search }) => (offers.includes(search) ? options : options.filter((each) => fits(each, search)))}
            limit={MOST}
          />
        )
      return <TextInput {...common} value={String(value)} onChange={(event) => onChange(event.currentTarget.value)} />
  }
}

const MOST = 100

function fits(option: object, search: string): boolean {
  return 'label' in option && String(option.label).toLowerCase().includes(search.trim().toLowerCase())
}

/** A step that suits the range: a twentieth of it, rounded to one digit. */
function stepOf(field: Field): number {
  if (field.kind === 'integer') return 1
  if (field.minimum === undefined || field.maximum === undefined) return 0.1
  return Number(((field.maximum - field.minimum) / 20).toPrecision(1))
}

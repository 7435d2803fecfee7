/** A number with its unit; nothing is a value of its own. */
import { Text, TextInput } from '@mantine/core'
import { useState } from 'react'

export interface NumberFieldProps {
  readonly label: string
  readonly unit: string
  readonly value: number | null
  readonly least: number
  readonly most: number
  /** The number, or nothing where the field is empty. */
  readonly onChange: (value: number | undefined) => void
}

export function NumberField({ label, unit, value, least, most, onChange }: NumberFieldProps) {
  const [text, setText] = useState(value === null ? '' : String(value))
  const number = Number(text)
  const isWrong = text.trim() !== '' && !(Number.isFinite(number) && number >= least && number <= most)
  return (
    <TextInput
      size="xs"
      label={
        <>
          {label}{' '}
          <Text span inherit fw={400} c="dimmed">
            {unit}
          </Text>
        </>
      }
      inputMode="decimal"
      placeholder="any"
      error={isWrong}
      title={isWrong ? `From ${least} to ${most}` : undefined}
      value={text}
      onChange={(event) => {
        const written = event.currentTarget.value
        setText(written)
        const given = Number(written)
        if (written.trim() === '') onChange(undefined)
        else if (Number.isFinite(given) && given >= least && given <= most) onChange(given)
      }}
    />
  )
}

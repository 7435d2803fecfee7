/** The form of a request or message, made from its JSON Schema, with what was answered or refused below it. */
import { Refusal } from '../../components/Refusal'
import { lookup, type Dict } from '../../document/dict'
import { Fieldset, Group, Stack, Text } from '@mantine/core'
import type { ReactNode } from 'react'
import { ParameterField } from '../../components/ParameterField'
import type { FormState } from './useForm'

interface RequestFormProps {
  readonly label: string
  readonly form: FormState
  readonly isOff: boolean
  readonly onSend: (request: Dict<unknown>) => void
  readonly refusal: string
  readonly buttons: ReactNode
}

export function RequestForm({ label, form, isOff, onSend, refusal, buttons }: RequestFormProps) {
  if (form.problem)
    return (
      <Text inherit c="var(--failed)">
        {form.problem}
      </Text>
    )
  if (!form.fields) return <div role="status" aria-label="Loading" />
  return (
    <form
      aria-label={label}
      noValidate
      onSubmit={(event) => {
        event.preventDefault()
        const request = isOff ? undefined : form.filled()
        if (request) onSend(request)
      }}
    >
      <Stack gap="xs">
        <Fieldset variant="unstyled" disabled={isOff}>
          <Stack gap="xs">
            {form.fields.length === 0 && (
              <Text fz="0.8rem" c="dimmed">
                It takes nothing.
              </Text>
            )}
            {form.fields.map((field) => (
              <ParameterField
                key={field.name}
                field={field}
                value={lookup(form.values, field.name)}
                problem={lookup(form.problems, field.name)}
                onChange={(value) => form.set(field.name, value)}
              />
            ))}
          </Stack>
        </Fieldset>
        <Group gap="2xs">{buttons}</Group>
        <Refusal>{refusal}</Refusal>
      </Stack>
    </form>
  )
}

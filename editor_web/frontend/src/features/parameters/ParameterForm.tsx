/** The form that sets a behavior's parameters for one run. */
import { Alert, Collapse, NumberInput, UnstyledButton } from '@mantine/core'
import { IconAlertCircle, IconChevronDown, IconChevronRight } from '@tabler/icons-react'
import { useState } from 'react'
import type { BehaviorBody } from '../../api/types'
import { ParameterField } from './ParameterField'
import { useStart } from './useStart'

/** The id by which buttons elsewhere on the page submit the form. */
export const FORM_ID = 'parameters'

export interface ParameterFormProps {
  readonly behavior: BehaviorBody
  /** Why it cannot be started now; undefined when it can. */
  readonly obstacle: string | undefined
  readonly onStarted: () => void
}

export function ParameterForm({ behavior, obstacle, onStarted }: ParameterFormProps) {
  const { fields, values, set, problems, refusal, submit, seed, setSeed } = useStart(behavior, onStarted)
  const [advanced, setAdvanced] = useState(false)
  const Chevron = advanced ? IconChevronDown : IconChevronRight
  return (
    <form
      id={FORM_ID}
      className="parameter-form"
      noValidate
      aria-label="Parameters"
      onSubmit={(event) => {
        event.preventDefault()
        if (obstacle === undefined) void submit()
      }}
    >
      {refusal && (
        <Alert color="red" variant="light" icon={<IconAlertCircle size={18} aria-hidden />} title="It was not started" role="alert">
          {refusal.message}
          {refusal.hint && <div className="quiet">{refusal.hint}</div>}
        </Alert>
      )}
      {fields.length === 0 && <p className="quiet">This behavior has no parameters.</p>}
      {fields.map((field) => (
        <ParameterField
          key={field.name}
          field={field}
          value={values[field.name]}
          problem={problems[field.name]}
          onChange={(value) => set(field.name, value)}
        />
      ))}
      <div>
        <UnstyledButton className="disclosure" aria-expanded={advanced} onClick={() => setAdvanced(!advanced)}>
          <Chevron size={14} aria-hidden /> Repeatability
        </UnstyledButton>
        <Collapse expanded={advanced}>
          <NumberInput
            size="sm"
            mt={8}
            label="Seed"
            description="The same seed draws the same random numbers; empty draws a new one"
            value={seed}
            onChange={setSeed}
            min={0}
            max={2 ** 31 - 1}
            allowDecimal={false}
          />
        </Collapse>
      </div>
    </form>
  )
}

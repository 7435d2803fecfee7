/** The values that are typed into a generated form, and what is wrong with them. */
import { lookup, type Dict } from '../../document/dict'
import { useState } from 'react'
import type { Answer } from '../../api/queryClient'
import { parametersOf, problemWith, type Field } from '../../document/schema'

export interface FormState {
  readonly fields: readonly Field[] | undefined
  /** Why there is no form. */
  readonly problem: string
  readonly values: Dict<unknown>
  readonly set: (name: string, value: unknown) => void
  readonly problems: Dict<string | undefined>
  /** What is to be sent; undefined where something is wrong, which is shown then. */
  readonly filled: () => Dict<unknown> | undefined
}

/** A form with these fields; what is typed into it stays when they are told again. */
export function useForm({ value: fields, problem = '' }: Answer<readonly Field[]>): FormState {
  const [typed, setTyped] = useState<Dict<unknown>>({})
  const [isChecked, setChecked] = useState(false)

  const values: Dict<unknown> = { ...Object.fromEntries((fields ?? []).map((field) => [field.name, field.initial])), ...typed }
  const problems = Object.fromEntries((fields ?? []).map((field) => [field.name, problemWith(field, lookup(values, field.name))]))

  function filled(): Dict<unknown> | undefined {
    setChecked(true)
    return fields && Object.values(problems).every((each) => each === undefined) ? parametersOf(fields, values) : undefined
  }

  return {
    fields,
    problem,
    values,
    set: (name, value) => setTyped((before) => ({ ...before, [name]: value })),
    problems: isChecked ? problems : {},
    filled,
  }
}

/** The values that are typed into a generated form, and what is wrong with them. */
import { lookup, type Dict } from '../../document/dict'
import { useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
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

/** A form whose fields are loaded once. */
export function useForm(load: () => Promise<readonly Field[]>): FormState {
  const [fields, setFields] = useState<readonly Field[]>()
  const [problem, setProblem] = useState('')
  const [values, setValues] = useState<Dict<unknown>>({})
  const [isChecked, setChecked] = useState(false)

  useEffect(() => {
    let isCurrent = true
    load().then(
      (loaded) => {
        if (!isCurrent) return
        setFields(loaded)
        setValues(Object.fromEntries(loaded.map((field) => [field.name, field.initial])))
      },
      (error: unknown) => isCurrent && setProblem(wordsOf(error)),
    )
    return () => {
      isCurrent = false
    }
    // oxlint-disable-next-line react/exhaustive-deps -- the form belongs to one entry and is made anew for another
  }, [])

  const problems = Object.fromEntries((fields ?? []).map((field) => [field.name, problemWith(field, lookup(values, field.name))]))

  function filled(): Dict<unknown> | undefined {
    setChecked(true)
    return fields && Object.values(problems).every((each) => each === undefined) ? parametersOf(fields, values) : undefined
  }

  return {
    fields,
    problem,
    values,
    set: (name, value) => setValues((before) => ({ ...before, [name]: value })),
    problems: isChecked ? problems : {},
    filled,
  }
}

/** The form's behavior: values, checks, and the request to start. */
import { useMemo, useState } from 'react'
import { api, ServerError } from '../../api/client'
import type { BehaviorBody, ErrorBody } from '../../api/types'
import { fieldOf, parametersOf, problemWith, type Field } from '../../document/schema'

type Values = Readonly<Record<string, unknown>>
type Problems = Readonly<Record<string, string | undefined>>

export function useStart(behavior: BehaviorBody, onStarted: () => void) {
  const fields = useMemo(() => behavior.parameters.map(fieldOf), [behavior])
  const [values, setValues] = useState<Values>(() => Object.fromEntries(fields.map((f) => [f.name, f.initial])))
  const [problems, setProblems] = useState<Problems>({})
  const [refusal, setRefusal] = useState<ErrorBody>()
  const [seed, setSeed] = useState<string | number>('')

  function set(name: string, value: unknown): void {
    setValues({ ...values, [name]: value })
    const field = fields.find((f) => f.name === name)
    setProblems({ ...problems, [name]: field && problemWith(field, value) })
  }

  async function submit(): Promise<void> {
    const found = problemsOf(fields, values)
    setProblems(found)
    setRefusal(undefined)
    if (Object.values(found).some(Boolean)) return
    try {
      const body = { behavior: behavior.id, parameters: parametersOf(fields, values), seed: seedOf(seed) }
      await api.start(body, newKey())
      onStarted()
    } catch (error) {
      const said = error instanceof ServerError ? error.body : { message: String(error), where: '', hint: '' }
      const name = fields.find((f) => said.where === f.name || said.where.endsWith(`.${f.name}`))?.name
      if (name) setProblems({ [name]: said.hint ? `${said.message} (${said.hint})` : said.message })
      else setRefusal(said)
    }
  }

  return { fields, values, set, problems, refusal, submit, seed, setSeed }
}

function problemsOf(fields: readonly Field[], values: Values): Problems {
  return Object.fromEntries(fields.map((field) => [field.name, problemWith(field, values[field.name])]))
}

function seedOf(seed: string | number): number | null {
  return seed === '' ? null : Number(seed)
}

function newKey(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(12)), (byte) => byte.toString(16).padStart(2, '0')).join('')
}

/** The form's behavior: values, checks, and the request to start. */
import { lookup, type Dict } from '../../document/dict'
import { useQueryClient } from '@tanstack/react-query'
import { useMemo, useState } from 'react'
import { useSavedBreakpoints } from '../../api/breakpoints'
import { cellConnectionQuery } from '../../api/cellConnection'
import { api, ServerError } from '../../api/client'
import { attached, operate } from '../../api/live'
import { originOf } from '../../api/origin'
import { clearRefusal, showRefusal, send } from '../../api/refusal'
import { mayMoveDevices } from '../../api/realDevices'
import type { BehaviorView, StartBody } from '../../api/types'
import { fieldOf, inputsOf, inputsText, parametersOf, problemWith, shownValue, type Field } from '../../document/schema'
import { SUPERVISION, supervisionOf, type Supervision } from '../../document/supervision'

type Values = Dict<unknown>
type Problems = Dict<string | undefined>

/** `place` says where the run starts and pauses, where that is not at the beginning and nowhere. */
export function useStart(behavior: BehaviorView, onStarted: () => void, place: Pick<StartBody, 'begin' | 'until'> = {}) {
  const client = useQueryClient()
  const fields = useMemo(() => behavior.parameters.map(fieldOf), [behavior])
  const [values, setValues] = useState<Values>(() => Object.fromEntries(fields.map((f) => [f.name, f.initial])))
  const [problems, setProblems] = useState<Problems>({})
  const [seed, setSeed] = useState<string | number>('')
  const [inputs, setInputs] = useState('')
  const data = inputsOf(inputs)
  const [supervision, setSupervision] = useState<Supervision>(SUPERVISION)
  const hasBreakpoints = useSavedBreakpoints((s) => s.kept.length > 0)

  function set(name: string, value: unknown): void {
    setValues({ ...values, [name]: value })
    const field = fields.find((f) => f.name === name)
    setProblems({ ...problems, [name]: field && problemWith(field, value) })
  }

  /** Fill the form with what a run was started with, seed and userdata included: started like that, it is repeated. */
  async function repeat(run: string): Promise<void> {
    const origin = await send('Take the values of the run', () => originOf(run))
    if (!origin) return
    setSeed(origin.seed)
    fill(origin.parameters, origin.inputs)
  }

  /** Put these parameters and this userdata into the form. */
  function fill(parameters: Dict<unknown>, userdata: Dict<unknown>): void {
    const known = fields.filter((field) => lookup(parameters, field.name) !== undefined)
    setValues({ ...values, ...Object.fromEntries(known.map(({ name, kind }) => [name, shownValue(kind, lookup(parameters, name))])) })
    setInputs(inputsText(userdata))
    setProblems({})
  }

  /** Start the run; whether the values are right, as far as the form and the server can tell. */
  async function submit(): Promise<boolean> {
    const found = problemsOf(fields, values)
    setProblems(found)
    clearRefusal()
    if (Object.values(found).some(Boolean) || !data) return false
    if (!(await mayMoveDevices())) return true
    try {
      const body: StartBody = {
        behavior: behavior.id,
        parameters: parametersOf(fields, values),
        inputs: data,
        seed: seedOf(seed),
        ...supervisionOf(supervision, hasBreakpoints),
        ...place,
      }
      const { run } = await api.start(body, newKey())
      onStarted()
      if (supervision.operates) await superviseRun(run)
    } catch (error) {
      const answer = error instanceof ServerError ? error.body : { message: String(error), where: '', hint: '' }
      const name = fields.find((f) => answer.where === f.name || answer.where.endsWith(`.${f.name}`))?.name
      if (name) setProblems({ [name]: answer.hint ? `${answer.message} (${answer.hint})` : answer.message })
      else showRefusal('Start', answer.message, answer.hint)
      // Perhaps because the cell is lost; whoever tells of that hears it.
      void client.prefetchQuery(cellConnectionQuery())
      return name === undefined
    }
    return true
  }

  /** Be its operator before its first node is entered, or it would ask nobody for the first outcomes. */
  async function superviseRun(run: string): Promise<void> {
    operate(run)
    if (supervision.startsPaused) return
    await attached(run)
    await send('Resume', () => api.resume(run))
  }

  return {
    fields,
    values,
    set,
    problems,
    submit,
    repeat,
    fill,
    seed,
    setSeed,
    inputs,
    setInputs,
    inputsProblem: data ? undefined : 'This is not a JSON object',
    supervision,
    setSupervision,
    hasBreakpoints,
  }
}

function problemsOf(fields: readonly Field[], values: Values): Problems {
  return Object.fromEntries(fields.map((field) => [field.name, problemWith(field, lookup(values, field.name))]))
}

function seedOf(seed: string | number): number | null {
  return seed === '' ? null : Number(seed)
}

function newKey(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(12)), (byte) => byte.toString(16).padStart(2, '0')).join('')
}

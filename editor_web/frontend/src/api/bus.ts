/** The skill bus over HTTP: what there is, forms, calls, publishing, parameters, and goals with their course. */
import type { Dict } from '../document/dict'
import { call, post, request as ask, sent, ServerError } from './client'
import type { ErrorBody } from './types'

export interface TopicFacts {
  readonly name: string
  readonly type: string
  readonly doc: string
  readonly takes_commands: boolean
}

export interface SkillFacts {
  readonly kind: 'service' | 'action'
  readonly name: string
  readonly type: string
  readonly doc: string
  readonly answer: string
}

export interface ParameterFacts {
  readonly name: string
  readonly doc: string
  readonly value: unknown
  readonly schema: Dict<unknown>
}

export interface BusListing {
  readonly shape: string
  readonly topics: readonly TopicFacts[]
  readonly skills: readonly SkillFacts[]
  readonly parameters: readonly ParameterFacts[]
}

export interface BusForm {
  readonly name: string
  readonly schema: Dict<unknown>
}

export interface SignalField {
  readonly path: string
  readonly label: string
  readonly unit: string
}

export interface TopicFields {
  readonly topic: string
  readonly type: string
  readonly fields: readonly SignalField[]
}

export type GoalStreamLine =
  | { readonly k: 'sent'; readonly goal: string }
  | { readonly k: 'course'; readonly status: string; readonly feedback: unknown }
  | { readonly k: 'end'; readonly status: string; readonly result: unknown; readonly cause: { readonly message: string } | null }

export const bus = {
  board: () => call<BusListing>('/bus/board'),
  fields: () => call<{ readonly topics: readonly TopicFields[] }>('/bus/fields'),
  requestForm: (address: string) => call<BusForm>(`/bus/form?address=${encodeURIComponent(address)}`),
  messageForm: (topic: string) => call<BusForm>(`/bus/form?topic=${encodeURIComponent(topic)}`),
  call: (address: string, request: Dict<unknown>) => post<unknown>('/bus/call', { address, request }),
  publish: (topic: string, message: Dict<unknown>) => post<void>('/bus/publish', { topic, message }),
  setParameter: (name: string, value: unknown) => sent<unknown>('PUT', '/bus/parameter', { name, value }),
  cancel: (goal: string) => post<void>(`/bus/goals/${encodeURIComponent(goal)}/cancel`, {}),
}

/** Send a goal and hear its course until it has ended; whoever aborts cancels it. */
export async function sendGoal(
  address: string,
  request: Dict<unknown>,
  onLine: (line: GoalStreamLine) => void,
  signal: AbortSignal,
): Promise<void> {
  const response = await ask('/bus/goals', {
    method: 'POST',
    headers: { 'content-type': 'application/json' },
    body: JSON.stringify({ address, request }),
    signal,
  })
  if (!response.ok || !response.body) throw new ServerError(response.status, await refusal(response))
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader()
  let rest = ''
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    const lines = (rest + part.value).split('\n')
    rest = lines.pop() ?? ''
    for (const line of lines) onLine(JSON.parse(line) as GoalStreamLine)
  }
}

async function refusal(response: Response): Promise<ErrorBody> {
  try {
    return (await response.json()) as ErrorBody
  } catch {
    return { message: response.statusText, where: '', hint: '' }
  }
}

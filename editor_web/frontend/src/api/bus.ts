/** The skill bus over HTTP: what there is, forms, calls, publishing, parameters, and goals with their course. */
import { queryOptions } from '@tanstack/react-query'
import type { Dict } from '../document/dict'
import { requestFields } from '../document/requestForm'
import { call, post, request as ask, sent, ServerError } from './client'
import { queryKeys } from './queryKeys'
import type { BusFields, BusForm, BusListing, ErrorBody, GoalStreamLine } from './types'

export const bus = {
  board: () => call<BusListing>('/bus/board'),
  fields: () => call<BusFields>('/bus/fields'),
  requestForm: (address: string) => call<BusForm>(`/bus/form?address=${encodeURIComponent(address)}`),
  messageForm: (topic: string) => call<BusForm>(`/bus/form?topic=${encodeURIComponent(topic)}`),
  call: (address: string, request: Dict<unknown>) => post<unknown>('/bus/call', { address, request }),
  publish: (topic: string, message: Dict<unknown>) => post<void>('/bus/publish', { topic, message }),
  setParameter: (name: string, value: unknown) => sent<unknown>('PUT', '/bus/parameter', { name, value }),
  cancel: (goal: string) => post<void>(`/bus/goals/${encodeURIComponent(goal)}/cancel`, {}),
}

/** New devices bring new numbers. */
const FIELDS_PERIOD_MS = 5000

export const busQueries = {
  /** `shape` is what the traffic calls the listing; it is another one when devices come or go. */
  listing: (shape: number | string | undefined) =>
    queryOptions({ queryKey: queryKeys.busListing(shape), queryFn: bus.board, enabled: shape !== undefined }),
  fields: () => queryOptions({ queryKey: queryKeys.busFields, queryFn: bus.fields, refetchInterval: FIELDS_PERIOD_MS }),
  requestForm: (address: string) =>
    queryOptions({
      queryKey: queryKeys.busForm('request', address),
      queryFn: async () => requestFields((await bus.requestForm(address)).schema),
      staleTime: Infinity,
    }),
  messageForm: (topic: string) =>
    queryOptions({
      queryKey: queryKeys.busForm('message', topic),
      queryFn: async () => requestFields((await bus.messageForm(topic)).schema),
      staleTime: Infinity,
    }),
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

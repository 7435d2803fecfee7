/** The HTTP interface: typed calls, and errors that carry the server's words. */
import type { BehaviorBody, BehaviorSummaryBody, ErrorBody, SessionBody, StartBody, StartedBody } from './types'

/** The server refused; `where` names the parameter or place it is about. */
export class ServerError extends Error {
  constructor(
    readonly status: number,
    readonly body: ErrorBody,
  ) {
    super(body.message)
    this.name = 'ServerError'
  }
}

async function call<T>(path: string, init?: RequestInit): Promise<T> {
  const response = await fetch(`/api/v1${path}`, { headers: { accept: 'application/json' }, ...init })
  const text = await response.text()
  const body: unknown = text ? parse(text) : undefined
  if (!response.ok) throw new ServerError(response.status, errorOf(body, response.statusText))
  return body as T
}

function parse(text: string): unknown {
  try {
    return JSON.parse(text)
  } catch {
    return undefined
  }
}

function errorOf(body: unknown, otherwise: string): ErrorBody {
  const given = typeof body === 'object' && body !== null ? (body as Partial<ErrorBody>) : {}
  return { message: given.message ?? otherwise, where: given.where ?? '', hint: given.hint ?? '' }
}

function post<T>(path: string, body: unknown, headers: Record<string, string> = {}): Promise<T> {
  return call<T>(path, {
    method: 'POST',
    headers: { 'content-type': 'application/json', accept: 'application/json', ...headers },
    body: JSON.stringify(body),
  })
}

function idPath(id: string): string {
  return id.split('/').map(encodeURIComponent).join('/')
}

export const api = {
  session: () => call<SessionBody>('/session'),
  behaviors: () => call<readonly BehaviorSummaryBody[]>('/behaviors'),
  behavior: (id: string) => call<BehaviorBody>(`/behaviors/${idPath(id)}`),
  /** `key` makes a repeated request (double click, lost answer) start one run only. */
  start: (body: StartBody, key: string) => post<StartedBody>('/runs', body, { 'idempotency-key': key }),
  resetParts: () => post<unknown>('/bus/call', { address: 'cell/reset_parts', request: {} }),
  stop: (run: string) => post<void>(`/runs/${encodeURIComponent(run)}/stop`, { reason: 'stopped in the dashboard' }),
}

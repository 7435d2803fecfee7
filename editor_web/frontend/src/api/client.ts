/** The HTTP interface: typed calls, and errors that carry the server's words. */
import { keepSession, loseSession } from './session'
import type {
  BehaviorView,
  BehaviorSummary,
  BreakpointsBody,
  HotChangeResultBody,
  InterruptedRun,
  ControlView,
  UserdataBody,
  ErrorBody,
  ResumeQuestion,
  ResumeBody,
  SessionBody,
  StartBody,
  StartData,
  StartResultBody,
  StepBody,
  HotChangeBody,
} from './types'
import { addressOf } from '../document/path'

/** The server refused; `where` names the parameter or place it is about. */
export class ServerError extends Error {
  constructor(
    readonly status: number,
    readonly body: ErrorBody,
    /** What an interrupted run asks before it goes on. */
    readonly questions: readonly ResumeQuestion[] = [],
    /** The whole answer, for refusals that say more. */
    readonly answer?: unknown,
  ) {
    super(body.message)
    this.name = 'ServerError'
  }
}

/** `fetch`, which says in plain words that nobody answers: what browsers say then is each one's own. */
export async function reach(url: string, init?: RequestInit): Promise<Response> {
  try {
    return await fetch(url, init)
  } catch (error) {
    if (error instanceof TypeError) throw new Error('The server does not answer', { cause: error })
    throw error
  }
}

/** Ask `/api/v1…` and look only at whether the server still knows this page. */
export async function request(path: string, init?: RequestInit): Promise<Response> {
  const response = await reach(`/api/v1${path}`, { headers: { accept: 'application/json' }, ...init })
  if (response.status === 401) loseSession()
  return response
}

/** Ask `/api/v1…`; a refusal is a ServerError. */
export async function call<T>(path: string, init?: RequestInit): Promise<T> {
  const response = await request(path, init)
  const text = await response.text()
  const body: unknown = text ? parse(text) : undefined
  if (!response.ok) throw refusedBy(response, body)
  return body as T
}

/** Send a body to `/api/v1…` for a file; a refusal is a ServerError. */
export function postForFile(path: string, body: unknown): Promise<Blob> {
  return getFile(path, { method: 'POST', headers: { 'content-type': 'application/json' }, body: JSON.stringify(body) })
}

/** Ask `/api/v1…` for a file; a refusal is a ServerError. */
export async function getFile(path: string, init?: RequestInit): Promise<Blob> {
  const response = await request(path, init)
  if (!response.ok) throw refusedBy(response, parse(await response.text()))
  return response.blob()
}

function refusedBy(response: Response, body: unknown): ServerError {
  return new ServerError(response.status, errorOf(body, response.statusText), questionsOf(body), body)
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

function questionsOf(body: unknown): readonly ResumeQuestion[] {
  const given = typeof body === 'object' && body !== null ? (body as { questions?: unknown }).questions : undefined
  return Array.isArray(given) ? (given as ResumeQuestion[]) : []
}

/** What the server said, in one line with its advice. */
export function wordsOf(error: unknown): string {
  if (error instanceof ServerError) return [error.body.message, error.body.hint].filter(Boolean).join(' – ')
  return error instanceof Error ? error.message : String(error)
}

export function sent<T>(
  method: 'POST' | 'PUT',
  path: string,
  body: unknown,
  headers: Record<string, string> = {},
  signal?: AbortSignal,
): Promise<T> {
  return call<T>(path, {
    method,
    headers: { 'content-type': 'application/json', accept: 'application/json', ...headers },
    body: JSON.stringify(body),
    ...(signal && { signal }),
  })
}

export function post<T>(path: string, body: unknown, headers: Record<string, string> = {}, signal?: AbortSignal): Promise<T> {
  return sent<T>('POST', path, body, headers, signal)
}

function command(run: string, name: string, body: unknown = {}): Promise<ControlView> {
  return post<ControlView>(`/runs/${encodeURIComponent(run)}/control/${name}`, body)
}

/** Ask who this page is, and keep the answer for all of it. */
async function session(): Promise<SessionBody> {
  const answer = await call<SessionBody>('/session')
  keepSession(answer)
  return answer
}

export const api = {
  session,
  behaviors: () => call<readonly BehaviorSummary[]>('/behaviors'),
  behavior: (id: string) => call<BehaviorView>(`/behaviors/${addressOf(id)}`),
  /** `key` makes a repeated request (double click, lost answer) start one run only. */
  start: (body: StartBody, key: string) => post<StartResultBody>('/runs', body, { 'idempotency-key': key }),
  /** The data with which a run can start at a node. */
  startData: (behavior: string, path: string) => call<StartData>(`/runs/start-data?${new URLSearchParams({ behavior, path }).toString()}`),
  resetParts: () => post<unknown>('/bus/call', { address: 'cell/reset_parts', request: {} }),
  pause: (run: string) => command(run, 'pause'),
  resume: (run: string) => command(run, 'resume'),
  step: (run: string, body: StepBody) => command(run, 'step', body),
  stepBack: (run: string, path: string) => command(run, 'step_back', { path }),
  lock: (run: string, path: string, reason: string) => command(run, 'lock', { path, reason }),
  unlock: (run: string, path: string) => command(run, 'unlock', { path }),
  force: (run: string, path: string, outcome: string) => command(run, 'force', { path, outcome }),
  repeat: (run: string, path: string) => command(run, 'repeat', { path }),
  userdata: (run: string, scope: string, key: string) =>
    call<UserdataBody>(`/runs/${encodeURIComponent(run)}/control/userdata?${new URLSearchParams({ scope, key }).toString()}`),
  setUserdata: (run: string, scope: string, key: string, value: unknown) => command(run, 'userdata', { scope, key, value }),
  answer: (run: string, path: string) => command(run, 'answer', { path }),
  autonomy: (run: string, level: string) => command(run, 'autonomy', { level }),
  breakpoints: (run: string, body: BreakpointsBody) => command(run, 'breakpoints', body),
  change: (run: string, body: HotChangeBody) => post<HotChangeResultBody>(`/runs/${encodeURIComponent(run)}/control/change`, body),
  keptBreakpoints: (behavior: string) => call<BreakpointsBody>(`/breakpoints/${addressOf(behavior)}`),
  keepBreakpoints: (behavior: string, body: BreakpointsBody) => sent<BreakpointsBody>('PUT', `/breakpoints/${addressOf(behavior)}`, body),
  interrupted: () => call<readonly InterruptedRun[]>('/interrupted'),
  resumeInterrupted: (run: string, body: ResumeBody) => post<StartResultBody>(`/interrupted/${encodeURIComponent(run)}/resume`, body),
  stopCell: (reason: string) => post<void>('/cell/stop', { reason }),
  setSpeed: (arm: string, share: number) => post<unknown>('/bus/call', { address: `${arm}/set_speed_override`, request: { share } }),
  recover: (arm: string) => post<unknown>('/bus/call', { address: `${arm}/recover_from_error`, request: {} }),
  stop: (run: string) => post<void>(`/runs/${encodeURIComponent(run)}/stop`, { reason: 'stopped in the dashboard' }),
}

/** The server's side of a page under test: what it answers to requests, and what its websockets tell. */
import { act } from '@testing-library/react'
import { vi } from 'vitest'
import type { ErrorBody } from '../src/api/types.ts'

/** One request of the page; the body is parsed where it is JSON. */
export interface Asked {
  readonly what: string
  readonly body: unknown
}

type Answer = (asked: Asked & { readonly query: URLSearchParams }) => unknown

/** An answer that is no success. */
export class Refusal {
  constructor(
    readonly status: number,
    readonly body: Partial<ErrorBody> & Readonly<Record<string, unknown>>,
  ) {}
}

/** One websocket that the page has opened. */
export class FakeSocket extends EventTarget {
  static readonly CONNECTING = 0
  static readonly OPEN = 1
  static readonly CLOSING = 2
  static readonly CLOSED = 3
  static opened: FakeSocket[] = []

  readonly sent: unknown[] = []
  readyState = FakeSocket.CONNECTING
  onopen: (() => void) | null = null
  onmessage: ((message: { readonly data: string }) => void) | null = null
  onclose: ((event?: unknown) => void) | null = null

  constructor(readonly url: string) {
    super()
    FakeSocket.opened.push(this)
  }

  send(text: string): void {
    this.sent.push(JSON.parse(text))
  }

  close(): void {
    if (this.readyState === FakeSocket.CLOSED) return
    this.readyState = FakeSocket.CLOSED
    this.onclose?.({})
  }

  /** Accept it, as the server does. */
  accept(): void {
    act(() => {
      this.readyState = FakeSocket.OPEN
      this.onopen?.()
    })
  }

  /** Say something to the page. */
  tell(message: unknown): void {
    act(() => this.onmessage?.({ data: JSON.stringify(message) }))
  }

  /** Cut it off. */
  cut(): void {
    act(() => this.close())
  }
}

/** Stands for the server as long as one test lasts; what it has no answer to fails the test in the end. */
export class FakeServer {
  readonly asked: Asked[] = []
  readonly unanswered: string[] = []
  private readonly answers = new Map<string, Answer>()

  constructor() {
    FakeSocket.opened = []
    vi.stubGlobal('fetch', (address: string, init?: RequestInit) => this.answer(address, init))
    vi.stubGlobal('WebSocket', FakeSocket)
  }

  /** Answer `METHOD /path` (below `/api/v1`, or a whole address) from now on, with a value or what a function makes. */
  on(what: string, answer: unknown): this {
    this.answers.set(what, typeof answer === 'function' ? (answer as Answer) : () => answer)
    return this
  }

  /** The bodies of all requests `METHOD /path` so far. */
  bodies(what: string): unknown[] {
    return this.asked.filter((each) => each.what === what).map((each) => each.body)
  }

  /** The newest websocket whose address ends so. */
  socket(end: string): FakeSocket {
    const found = FakeSocket.opened.findLast((each) => each.url.split('?')[0]?.endsWith(end))
    if (!found)
      throw new Error(`the page has opened no websocket …${end}; it has ${FakeSocket.opened.map((each) => each.url).join(', ') || 'none'}`)
    return found
  }

  private async answer(address: string, init?: RequestInit): Promise<Response> {
    const url = new URL(address, location.origin)
    const isOurs = url.origin === location.origin
    const path = isOurs ? url.pathname.replace('/api/v1', '') : `${url.origin}${url.pathname}`
    const what = `${init?.method ?? 'GET'} ${path}`
    const asked = { what, body: read(init?.body) }
    this.asked.push(asked)
    const answer = this.answers.get(what)
    if (!answer) {
      this.unanswered.push(what)
      return respond(404, { message: `nothing answers ${what}`, where: '', hint: '' })
    }
    const made = await answer({ ...asked, query: url.searchParams })
    if (made instanceof Response) return made
    return made instanceof Refusal ? respond(made.status, { message: '', where: '', hint: '', ...made.body }) : respond(200, made)
  }
}

function respond(status: number, body: unknown): Response {
  return new Response(body === undefined ? null : JSON.stringify(body), { status, headers: { 'content-type': 'application/json' } })
}

function read(body: BodyInit | null | undefined): unknown {
  if (typeof body !== 'string') return body instanceof URLSearchParams ? Object.fromEntries(body) : body
  try {
    return JSON.parse(body) as unknown
  } catch {
    return body
  }
}

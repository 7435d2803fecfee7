/** The live connection: one websocket, reopened when it is lost, folded into one store. */
import { create } from 'zustand'
import { EMPTY, fold, isActive, type LiveState } from '../document/live'
import { atMoment, type ShownMoment } from '../document/timelineMoment'
import { api, ServerError } from './client'
import { PAGE, useShown } from './shown'
import type { Frame, Operate, Show, Watch } from './types'

export type Connection = 'connecting' | 'live' | 'lost' | 'denied'

interface LiveStore extends LiveState {
  readonly connection: Connection
  /** Counts restarts of the server; what was fetched before one is out of date. */
  readonly generation: number
  /** The run that this page operates; kept over a reload of the page, empty for none. */
  readonly operated: string
  /** The moment of the past whose nodes, log and clock are shown in the place of the live ones. */
  readonly past: ShownMoment | undefined
  /** Whether the server has told what runs it has. */
  readonly knowsRuns: boolean
}

const OPERATED = 'flexcell.operated'

export const useLive = create<LiveStore>(() => ({
  ...EMPTY,
  connection: 'connecting',
  generation: 0,
  operated: sessionStorage.getItem(OPERATED) ?? '',
  past: undefined,
  knowsRuns: false,
}))

/** What the stream has told, also while the past is shown. */
let streamed: LiveState = EMPTY

/** Show a moment of the past from now on; undefined shows what is live again. */
export function showMoment(past: ShownMoment | undefined): void {
  useLive.setState({ ...(past ? atMoment(streamed, past) : streamed), past })
}

/** The last event of the watched run that the stream has told of. */
export function streamedSeq(): number {
  return streamed.seq
}

const SILENCE_MS = 12_000
const ANSWER_MS = 4000
const RETRY_MS = [250, 500, 1000, 2000, 3000]

let socket: WebSocket | undefined
let watched = ''
let attempt = 0
let silence: ReturnType<typeof setTimeout> | undefined

/** Show this run from now on; empty for none. */
export function watch(run: string): void {
  if (run === watched) return
  watched = run
  sendWatch()
}

/** Be the operator of this run from now on, until it is over or the page says so; empty leaves it. */
export function operate(run: string): void {
  if (run) sessionStorage.setItem(OPERATED, run)
  else sessionStorage.removeItem(OPERATED)
  useLive.setState({ operated: run })
  sendOperate()
}

/** Wait until the run that is shown has an operator. */
export function attached(run: string): Promise<void> {
  return new Promise((resolve) => {
    const isAttached = () => useLive.getState().run === run && useLive.getState().control?.operator === 'attached'
    const unsubscribe = useLive.subscribe(() => isAttached() && (unsubscribe(), resolve()))
    if (isAttached()) {
      unsubscribe()
      resolve()
    }
  })
}

/** The server's clock now, seconds since 1970. */
export function serverNow(): number {
  return useLive.getState().serverZeroS + performance.now() / 1000
}

/** Open the connection and keep it open; returns how to end it. */
export function connect(): () => void {
  let ended = false
  let retry: ReturnType<typeof setTimeout> | undefined

  function open(): void {
    const opened = new WebSocket(`${location.origin.replace(/^http/, 'ws')}/api/v1/live`)
    socket = opened
    opened.onopen = () => {
      attempt = 0
      sendShow()
      if (watched) sendWatch()
      if (useLive.getState().operated) sendOperate()
    }
    opened.onmessage = (message: MessageEvent<string>) => {
      if (socket === opened) receive(opened, JSON.parse(message.data) as Frame)
    }
    opened.onclose = () => {
      if (socket !== opened) return
      clearTimeout(silence)
      socket = undefined
      if (ended) return
      streamed = { ...streamed, ticking: false }
      useLive.setState({ connection: 'lost', ticking: false })
      void again()
    }
    listenForSilence(opened)
  }

  async function again(): Promise<void> {
    // A refused websocket says nothing about why; the session does.
    const denied = await Promise.race([api.session(), soon(ANSWER_MS)]).then(
      () => false,
      (error: unknown) => error instanceof ServerError && error.status === 401,
    )
    if (ended) return
    if (denied) {
      useLive.setState({ connection: 'denied' })
      return
    }
    retry = setTimeout(open, RETRY_MS[Math.min(attempt, RETRY_MS.length - 1)])
    attempt += 1
  }

  const unsubscribe = useShown.subscribe(sendShow)
  open()
  return () => {
    ended = true
    unsubscribe()
    clearTimeout(retry)
    clearTimeout(silence)
    socket?.close()
  }
}

function receive(from: WebSocket, frame: Frame): void {
  listenForSilence(from)
  if (frame.k === 'ping') {
    from.send(JSON.stringify({ k: 'pong' }))
    return
  }
  const before = useLive.getState()
  const next = fold(streamed, frame, performance.now())
  if (next === 'gap') {
    sendWatch()
    return
  }
  const restarted = before.epoch !== '' && before.epoch !== next.epoch
  streamed = next
  const picture = before.past ? atMoment(next, before.past) : next
  const knowsRuns = frame.k === 'snapshot' || (before.knowsRuns && !restarted)
  useLive.setState({ ...picture, connection: 'live', generation: before.generation + (restarted ? 1 : 0), knowsRuns })
  // A run that is over, or of another server, has no operator any more.
  const operated = next.runs.find((run) => run.id === before.operated)
  if (before.operated && (restarted || (operated && !isActive(operated)))) operate('')
}

/** The server speaks every five seconds; a connection that is silent for longer is dead. */
function listenForSilence(on: WebSocket): void {
  clearTimeout(silence)
  silence = setTimeout(() => {
    on.close()
    // Where nobody answers any more, the browser would wait a minute for the other side to agree.
    on.onclose?.(new CloseEvent('close'))
  }, SILENCE_MS)
}

/** After a time, whatever became of what was asked. */
function soon(ms: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, ms))
}

function sendOperate(): void {
  const request: Operate = { k: 'operate', run: useLive.getState().operated }
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(request))
}

function sendShow(): void {
  const request: Show = { k: 'show', page: PAGE, groups: useShown.getState().groups }
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(request))
}

function sendWatch(): void {
  const request: Watch = { k: 'watch', run: watched }
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(request))
}

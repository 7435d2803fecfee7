/** The live connection: one websocket, reopened when it is lost, folded into one store. */
import { create } from 'zustand'
import { EMPTY, fold, isActive, type LiveState } from '../document/live'
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
}

const OPERATED = 'flexcell.operated'

export const useLive = create<LiveStore>(() => ({
  ...EMPTY,
  connection: 'connecting',
  generation: 0,
  operated: sessionStorage.getItem(OPERATED) ?? '',
}))

const SILENCE_MS = 12_000
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
    opened.onmessage = (message: MessageEvent<string>) => receive(opened, JSON.parse(message.data) as Frame)
    opened.onclose = () => {
      clearTimeout(silence)
      if (ended || socket !== opened) return
      useLive.setState({ connection: 'lost', ticking: false })
      void again()
    }
    listenForSilence(opened)
  }

  async function again(): Promise<void> {
    // A refused websocket says nothing about why; the session does.
    const denied = await api.session().then(
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
  const next = fold(before, frame, performance.now())
  if (next === 'gap') {
    sendWatch()
    return
  }
  const restarted = before.epoch !== '' && before.epoch !== next.epoch
  useLive.setState({ ...next, connection: 'live', generation: before.generation + (restarted ? 1 : 0) })
  // A run that is over, or of another server, has no operator any more.
  const operated = next.runs.find((run) => run.id === before.operated)
  if (before.operated && (restarted || (operated && !isActive(operated)))) operate('')
}

/** The server speaks every five seconds; a connection that is silent for longer is dead. */
function listenForSilence(on: WebSocket): void {
  clearTimeout(silence)
  silence = setTimeout(() => on.close(), SILENCE_MS)
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

/** A websocket to the live stream: opened again when it is lost, given up when it is silent. */
import { api, ServerError } from './client'
import type { Frame, LookAt, OperateRun, ScrubPath, ShowLayers, ShowPresence, WatchRun } from './types'
import { openSocket } from './socket'

export interface ConnectionEvents {
  /** It is open; what the server is to know of this side is sent now. */
  readonly onOpen: () => void
  readonly onFrame: (frame: Frame) => void
  readonly onLost: () => void
  /** The server does not know this page any more; it is asked again until somebody has logged in. */
  readonly onDenied: () => void
}

export interface LiveConnection {
  /** Send, or do nothing while it is not open. */
  readonly send: (request: WatchRun | OperateRun | ShowLayers | ScrubPath | LookAt | ShowPresence) => void
  readonly close: () => void
}

const SILENCE_MS = 12_000
const ANSWER_MS = 4000
const RETRY_MS = [250, 500, 1000, 2000, 3000]
const LOGGED_OUT_MS = 2000

/** Open a connection and keep it open. */
export function keepConnected(events: ConnectionEvents): LiveConnection {
  let socket: WebSocket | undefined
  let ended = false
  let attempt = 0
  let retry: ReturnType<typeof setTimeout> | undefined
  let silence: ReturnType<typeof setTimeout> | undefined

  function open(): void {
    const opened = openSocket('/live')
    socket = opened
    opened.onopen = () => {
      attempt = 0
      if (!ended) events.onOpen()
    }
    opened.onmessage = (message: MessageEvent<string>) => {
      if (socket === opened && !ended) receive(opened, JSON.parse(message.data) as Frame)
    }
    opened.onclose = () => {
      if (socket !== opened) return
      clearTimeout(silence)
      socket = undefined
      if (ended) return
      events.onLost()
      void again()
    }
    listenForSilence(opened)
  }

  function receive(from: WebSocket, frame: Frame): void {
    listenForSilence(from)
    if (frame.k === 'ping') from.send(JSON.stringify({ k: 'pong' }))
    else events.onFrame(frame)
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

  async function again(): Promise<void> {
    // A refused websocket says nothing about why; the session does.
    const denied = await Promise.race([api.session(), soon(ANSWER_MS)]).then(
      () => false,
      (error: unknown) => error instanceof ServerError && error.status === 401,
    )
    if (ended) return
    if (denied) {
      events.onDenied()
      attempt = 0
      retry = setTimeout(() => void again(), LOGGED_OUT_MS)
      return
    }
    retry = setTimeout(open, RETRY_MS[Math.min(attempt, RETRY_MS.length - 1)])
    attempt += 1
  }

  open()
  return {
    send: (request) => {
      if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(request))
    },
    close: () => {
      ended = true
      clearTimeout(retry)
      clearTimeout(silence)
      socket?.close()
    },
  }
}

/** After a time, whatever became of what was asked. */
function soon(ms: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, ms))
}

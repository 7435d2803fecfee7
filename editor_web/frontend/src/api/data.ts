/** The data stream: traffic, messages, samples, userdata and goals, each only while somebody looks at it. */
import { useEffect, useRef } from 'react'
import { openSocket } from './socket'
import type { DataFrame, DataSubscription } from './types'

/** What is looked at. */
export type Look = Omit<DataSubscription, 'k'>

const RETRY_MS = 1500

/** Look at something for as long as it is given; nothing is sent while it is undefined. `look` is compared by what it says. */
export function useData(look: Look | undefined, onFrame: (frame: DataFrame) => void): void {
  const handler = useRef(onFrame)
  useEffect(() => {
    handler.current = onFrame
  })
  const request = look && JSON.stringify({ k: 'look', ...look })
  const isOn = request !== undefined
  const stream = useRef<Stream>(undefined)
  useEffect(() => {
    if (!isOn) return
    const opened = new Stream((frame) => handler.current(frame))
    stream.current = opened
    return () => opened.close()
  }, [isOn])
  useEffect(() => {
    if (request !== undefined) stream.current?.ask(request)
  }, [request])
}

/** One connection, opened again when it is lost. */
class Stream {
  private socket: WebSocket | undefined
  private request = ''
  private isClosed = false
  private retry: ReturnType<typeof setTimeout> | undefined

  constructor(private readonly onFrame: (frame: DataFrame) => void) {
    this.open()
  }

  ask(request: string): void {
    this.request = request
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(request)
  }

  close(): void {
    this.isClosed = true
    clearTimeout(this.retry)
    this.socket?.close()
  }

  private open(): void {
    const socket = openSocket('/data')
    this.socket = socket
    socket.onopen = () => this.request && socket.send(this.request)
    socket.onmessage = (message: MessageEvent<string>) => {
      if (!this.isClosed) this.onFrame(JSON.parse(message.data) as DataFrame)
    }
    socket.onclose = () => {
      if (!this.isClosed) this.retry = setTimeout(() => this.open(), RETRY_MS)
    }
  }
}

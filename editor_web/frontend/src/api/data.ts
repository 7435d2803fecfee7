/** The data stream: traffic, messages, samples, userdata and goals, each only while somebody looks at it. */
import type { Dict } from '../document/dict'
import { useEffect, useRef } from 'react'
import { openSocket } from './socket'

export interface DataSubscription {
  /** Comes back with the samples of these `fields`. */
  readonly number?: number
  readonly traffic?: boolean
  readonly topic?: string
  /** Each `topic:path`. */
  readonly fields?: readonly string[]
  /** The run whose userdata is looked at. */
  readonly run?: string
  /** The run whose goals are looked at. */
  readonly goals?: string
}

export interface TopicMetrics {
  readonly rate_hz: number
  readonly age_s: number | null
  readonly on_demand: boolean
  readonly subscribers: number
}

export interface LeaseMetrics {
  readonly resource: string
  readonly run: string
  readonly node: string
  readonly goal: string
  readonly held_s: number
}

export interface GoalMetrics {
  readonly id: string
  readonly address: string
  readonly run: string
  readonly node: string
  readonly status: string
}

export interface BusMetricsFrame {
  readonly k: 'traffic'
  readonly shape: string
  readonly topics: Dict<TopicMetrics>
  readonly leases: readonly LeaseMetrics[]
  readonly goals: readonly GoalMetrics[]
}

export interface MessageFrame {
  readonly k: 'message'
  readonly topic: string
  readonly at_s: number
  readonly value: unknown
  readonly problem: string
}

export interface SamplesFrame {
  readonly k: 'samples'
  readonly number: number
  readonly times_s: readonly number[]
  readonly rows: readonly (readonly (number | null)[])[]
  readonly dropped: number
}

export interface UserdataValue {
  readonly value: unknown
  /** Path of the node that wrote it last; empty for what it began with. */
  readonly by: string
  readonly at_s: number
  readonly writes: number
}

export interface UserdataScope {
  readonly is_open: boolean
  readonly since_s: number
  readonly values: Dict<UserdataValue>
}

export interface UserdataFrame {
  readonly k: 'userdata'
  readonly run: string
  readonly first: boolean
  readonly scopes: Dict<UserdataScope | null>
  readonly problem: string
}

export interface GoalProgress {
  readonly address: string
  readonly status: string
  readonly share: number | null
  readonly words: string
}

export interface GoalsFrame {
  readonly k: 'goals'
  readonly run: string
  readonly goals: Dict<GoalProgress>
}

export type DataFrame = BusMetricsFrame | MessageFrame | SamplesFrame | UserdataFrame | GoalsFrame | { readonly k: 'ping' }

const RETRY_MS = 1500

/** Look at something for as long as it is given; nothing is sent while it is undefined. `look` is compared by what it says. */
export function useData(look: DataSubscription | undefined, onFrame: (frame: DataFrame) => void): void {
  const told = useRef(onFrame)
  useEffect(() => {
    told.current = onFrame
  })
  const request = look && JSON.stringify({ k: 'look', ...look })
  const isOn = request !== undefined
  const stream = useRef<Stream>(undefined)
  useEffect(() => {
    if (!isOn) return
    const opened = new Stream((frame) => told.current(frame))
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

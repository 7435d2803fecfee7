/** The connection of the page for teaching: what jogs and presses ends with it; and what it asks over HTTP. */
import type { Dict } from '../document/dict'
import { queryOptions } from '@tanstack/react-query'
import { call, post } from './client'
import { useLive } from './live'
import type {
  ArmInfo,
  ArmLive,
  Capture,
  EntryHistory,
  EntryPage,
  EntryRecord,
  GoalEnd,
  ItemHandleMoved,
  JogBlockFrame,
  JogReadiness,
  PrimitiveComparison,
  PreviewTaught,
  PlayBody,
  PlaybackResult,
  PressDropped,
  PushToolBody,
  RefusedFrame,
  SaveCapture,
  TagsBody,
  TeachingFrame,
  TeachingMessage,
  TeachStatus,
  Trigger,
  TriggerDocument,
} from './types'
import { PAGE } from './layerGroups'
import { queryKeys } from './queryKeys'
import { openSocket } from './socket'
import { pageStore } from './pageStore'

export interface TeachStore {
  readonly isOpen: boolean
  /** Undefined until the server has told. */
  readonly arms: readonly ArmInfo[] | undefined
  readonly canPush: boolean
  /** The names of all frames of the cell. */
  readonly frames: readonly string[]
  readonly now: Dict<ArmLive>
  /** Null where there is no Helping Hand, undefined until told. */
  readonly hand: TeachStatus | null | undefined
  /** Whether something is shown in the cell. */
  readonly isPreviewing: boolean
  /** Counts changes of the store. */
  readonly entries: number
  /** The arm that this page jogs. */
  readonly jogging: string
  readonly heldBy: string
  /** Whether an arm can be jogged at once, of those that this page has asked to prepare. */
  readonly readiness: Dict<JogReadiness>
  /** The latest press that has moved nothing; undefined from the next press on. */
  readonly dropped: PressDropped | undefined
  /** What the jogged arm stands before; undefined for nothing. */
  readonly block: JogBlockFrame | undefined
  /** Where the handle of an item is dragged; undefined until that is told. */
  readonly placed: ItemHandleMoved | undefined
  readonly refused: Readonly<Partial<Record<RefusedFrame['what'], RefusedFrame>>>
}

const NOTHING: TeachStore = {
  isOpen: false,
  arms: undefined,
  canPush: false,
  frames: [],
  now: {},
  hand: undefined,
  isPreviewing: false,
  entries: 0,
  jogging: '',
  heldBy: '',
  readiness: {},
  dropped: undefined,
  block: undefined,
  placed: undefined,
  refused: {},
}

export const useTeach = pageStore<TeachStore>(() => NOTHING)

const RETRY_MS = 1000

/** Say something to the server; nothing while it is not connected. */
export function sendToServer(message: TeachingMessage): void {
  connection.getState().send(message)
}

/** Take the words of a refusal away. */
export function clearTeachRefusal(what: RefusedFrame['what']): void {
  const { [what]: _, ...others } = useTeach.getState().refused
  useTeach.setState({ refused: others })
}

/** Take away what is said of the press before. */
export function forgetJogWords(): void {
  clearTeachRefusal('jog')
  useTeach.setState({ dropped: undefined })
}

/** Forget what the arm stood before: its directions out were of other axes. */
export function forgetJogBlock(): void {
  useTeach.setState({ block: undefined })
}

/** Keep the connection open for one more user; returns how to end that, with the last one the connection ends. */
export function connectTeach(): () => void {
  return connection.getState().use()
}

/** The connection for teaching, open for as long as somebody uses it. */
class Connection {
  private users = 0
  private socket: WebSocket | undefined
  private retry: ReturnType<typeof setTimeout> | undefined

  use(): () => void {
    this.users += 1
    if (this.users === 1) this.open()
    return () => {
      this.users -= 1
      if (this.users === 0) this.end()
    }
  }

  send(message: TeachingMessage): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message))
  }

  /** Nothing is told any more. */
  end(): void {
    const { socket } = this
    this.users = 0
    this.socket = undefined
    clearTimeout(this.retry)
    socket?.close()
    useTeach.setState(NOTHING)
  }

  private open(): void {
    const opened = openSocket(`/teach/live?page=${PAGE}`)
    this.socket = opened
    opened.onopen = () => useTeach.setState({ isOpen: true })
    opened.onmessage = (message: MessageEvent<string>) => {
      if (this.socket === opened) take(JSON.parse(message.data) as TeachingFrame)
    }
    opened.onclose = () => {
      if (this.socket !== opened) return
      useTeach.setState({
        isOpen: false,
        jogging: '',
        heldBy: '',
        readiness: {},
        dropped: undefined,
        block: undefined,
        placed: undefined,
        isPreviewing: false,
      })
      this.retry = setTimeout(() => this.open(), RETRY_MS)
    }
  }
}

const connection = pageStore(
  () => new Connection(),
  (ended) => ended.end(),
)

function take(message: TeachingFrame): void {
  const before = useTeach.getState()
  switch (message.k) {
    case 'arms':
      useTeach.setState({ arms: message.arms, canPush: message.can_push, frames: message.frames })
      break
    case 'now':
      useTeach.setState({ now: { ...before.now, ...message.arms } })
      break
    case 'hand':
      useTeach.setState({ hand: message.status })
      break
    case 'entries':
      useTeach.setState({ entries: before.entries + 1 })
      break
    case 'jogging':
      useTeach.setState({ jogging: message.arm, heldBy: message.held_by })
      break
    case 'ready':
      useTeach.setState({ readiness: { ...before.readiness, [message.arm]: message } })
      break
    case 'dropped':
      useTeach.setState({ dropped: message })
      break
    case 'placed':
      useTeach.setState({ placed: message })
      break
    case 'block':
      useTeach.setState({ block: message.first ? message : undefined })
      break
    case 'refused':
      useTeach.setState({ refused: { ...before.refused, [message.what]: message } })
  }
}

/** Why nothing can be commanded now; undefined where it can. */
export function useDisabledReason(): string | undefined {
  const isOpen = useTeach((s) => s.isOpen)
  const role = useLive((s) => s.role)
  if (!isOpen) return 'the server does not answer'
  return role === 'operator' ? undefined : 'you may look only; log in with the operator token'
}

/** Names an entry, or a capture by its number; without `revision`, what the entry is now. */
export type TaughtReference = Pick<PreviewTaught, 'revision'> & Required<Pick<PreviewTaught, 'kind' | 'name' | 'capture'>>

/** Show in the cell where an arm is along something; beside what is shown there already, where the place is not 0. */
export function previewTaught(arm: string, what: TaughtReference, place = 0): void {
  clearTeachRefusal('look')
  useTeach.setState({ isPreviewing: arm !== '' })
  sendToServer({ k: 'look', arm, revision: 0, ...what, place })
}

/** Show nothing any more. */
export function endPreview(): void {
  previewTaught('', { kind: '', name: '', capture: 0 })
}

function ask<T>(address: string, request: unknown): Promise<T> {
  return post<T>('/bus/call', { address, request })
}

function query(fields: Dict<string | number>): string {
  return new URLSearchParams(Object.entries(fields).map(([name, value]) => [name, String(value)])).toString()
}

function aborted<T>(path: string, body: unknown, signal: AbortSignal): Promise<T> {
  const headers = { 'content-type': 'application/json', accept: 'application/json' }
  return call<T>(path, { method: 'POST', headers, body: JSON.stringify(body), signal })
}

export const teach = {
  entries: (kind: string, text: string) => call<EntryPage>(`/teach/entries?${query({ kind, text })}`),
  fits: (arm: string, what: TaughtReference) => call<PrimitiveComparison>(`/teach/fits?${query({ arm, ...what })}`),
  now: (robot: string, callback: Trigger['trig_callback'], pressed = true) =>
    ask<TeachStatus>('teach/teach_now', { robot, callback, pressed }),
  frame: (robot: string, source_frame: string, target_frame: string) =>
    ask<TeachStatus>('teach/teach_now', { robot, callback: 'tf_save', pressed: true, source_frame, target_frame }),
  capture: (id: number) => ask<Capture>('teach/read_capture', { id }),
  save: (body: SaveCapture) => ask<unknown>('teach/save_capture', body),
  discard: (id: number) => ask<TeachStatus>('teach/discard_capture', { id }),
  setTriggers: (triggers: readonly Trigger[]) => ask<TeachStatus>('teach/set_triggers', { triggers }),
  document: () => ask<TriggerDocument>('teach/read_trigger_document', {}),
  writeDocument: (text: string) => ask<TeachStatus>('teach/write_trigger_document', { text }),
  history: (kind: string, name: string) => ask<EntryHistory>('store/read_history', { kind, name }),
  revision: (kind: string, name: string, revision: number) => ask<EntryRecord>('store/read_revision', { kind, name, revision }),
  tag: (body: TagsBody) => post<void>('/teach/tags', body),
  undo: (kind: string, name: string) => ask<unknown>('store/undo_entry', { kind, name, by: 'the dashboard', reason: 'undone' }),
  remove: (kind: string, name: string) => ask<unknown>('store/delete_entry', { kind, name, by: 'the dashboard', reason: 'deleted' }),
  /** Ends when the arm rests, also when it is aborted. */
  play: (body: PlayBody, signal: AbortSignal) => aborted<PlaybackResult>('/teach/play', body, signal),
  goal: (address: string, request: unknown, signal: AbortSignal) => aborted<GoalEnd>('/bus/goal', { address, request }, signal),
  push: (body: PushToolBody) => post<void>('/teach/push', body),
}

/** It is edited: what somebody typed before does not come back from what is kept here. */
export function triggerDocumentQuery() {
  return queryOptions({ queryKey: queryKeys.triggers, queryFn: teach.document, gcTime: 0 })
}

/** Past moments in the 3D view of this page: asked for over a connection of their own, which ends with the past. */
import { create } from 'zustand'
import { PAGE } from './layerGroups'
import { openSocket } from './socket'
import type { PastViewRequest, PastViewState } from './types'

interface PastStore {
  /** What was asked for; null for the present. */
  readonly requested: PastViewRequest | null
  /** What the server has drawn last of it. */
  readonly shown: PastViewState | null
}

export const usePast = create<PastStore>(() => ({ requested: null, shown: null }))

const AGAIN_MS = 1000

let socket: WebSocket | undefined
let again: ReturnType<typeof setTimeout> | undefined

/** Let the 3D view of this page show a run as it was at a time of it; null lets it show the present again. */
export function showCellAt(run: string, timeS: number | null): void {
  if (timeS === null) {
    leave()
    return
  }
  const { requested, shown } = usePast.getState()
  const isSameRun = requested?.run === run
  usePast.setState({ requested: { run, time_s: timeS }, shown: isSameRun ? shown : null })
  // A run that was not recorded has no other moment either.
  if (isSameRun && shown?.problem) return
  if (socket === undefined) open()
  else send()
}

function leave(): void {
  clearTimeout(again)
  socket?.close()
  socket = undefined
  usePast.setState({ requested: null, shown: null })
}

function open(): void {
  const opened = openSocket(`/cell/past/${PAGE}`)
  socket = opened
  opened.onopen = send
  opened.onmessage = (message: MessageEvent<string>) => {
    const state = JSON.parse(message.data) as PastViewState
    if (socket === opened && usePast.getState().requested?.run === state.run) usePast.setState({ shown: state })
  }
  opened.onclose = () => {
    if (socket !== opened) return
    socket = undefined
    usePast.setState({ shown: null })
    again = setTimeout(() => usePast.getState().requested && socket === undefined && open(), AGAIN_MS)
  }
}

function send(): void {
  const { requested } = usePast.getState()
  if (requested && socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(requested))
}

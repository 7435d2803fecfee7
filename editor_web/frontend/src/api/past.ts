/** Past moments in the 3D view of this page: asked for over a connection of their own, which ends with the past. */
import { PAGE } from './layerGroups'
import { openSocket } from './socket'
import type { GhostRequest, PastViewRequest, PastViewState } from './types'
import { pageStore } from './pageStore'

interface PastStore {
  /** What was asked for; null for the present. */
  readonly requested: PastViewRequest | null
  /** What the server has drawn last of it. */
  readonly shown: PastViewState | null
}

export const usePast = pageStore<PastStore>(() => ({ requested: null, shown: null }))

const AGAIN_MS = 1000

/** Let the 3D view of this page show a run as it was at a time of it, and the arms of another; null: the present again. */
export function showCellAt(run: string, timeS: number | null, ghost: GhostRequest | null = null): void {
  const { requested, shown } = usePast.getState()
  if (timeS === null) {
    connection.getState().close()
    usePast.setState({ requested: null, shown: null })
    return
  }
  const isSameRun = requested?.run === run
  usePast.setState({ requested: { run, time_s: timeS, ghost }, shown: isSameRun ? shown : null })
  // A run that was not recorded has no other moment either.
  if (isSameRun && shown?.problem) return
  connection.getState().ask()
}

/** The connection over which moments are asked for: opened with the first of them, and again when it is lost. */
class Connection {
  private socket: WebSocket | undefined
  private again: ReturnType<typeof setTimeout> | undefined

  /** Ask for what is requested now, as soon as it is open. */
  ask(): void {
    if (this.socket === undefined) this.open()
    else this.send()
  }

  close(): void {
    const { socket } = this
    this.socket = undefined
    clearTimeout(this.again)
    socket?.close()
  }

  private open(): void {
    const opened = openSocket(`/cell/past/${PAGE}`)
    this.socket = opened
    opened.onopen = () => this.send()
    opened.onmessage = (message: MessageEvent<string>) => {
      const state = JSON.parse(message.data) as PastViewState
      if (this.socket === opened && usePast.getState().requested?.run === state.run) usePast.setState({ shown: state })
    }
    opened.onclose = () => {
      if (this.socket !== opened) return
      this.socket = undefined
      usePast.setState({ shown: null })
      this.again = setTimeout(() => usePast.getState().requested && this.socket === undefined && this.open(), AGAIN_MS)
    }
  }

  private send(): void {
    const { requested } = usePast.getState()
    if (requested && this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(requested))
  }
}

const connection = pageStore(
  () => new Connection(),
  (ended) => ended.close(),
)

/** The handle at an arm in the 3D view of this page: over a connection of its own, with which it ends.
 *
 * The arm follows only while the mouse is down in the view and this page passes that on, every 50 ms: neither says so in
 * the other's name, so an arm rests when either of them hangs.
 */
import { PAGE } from './layerGroups'
import { openSocket } from './socket'
import type { HandleStatus, RefusedFrame } from './types'
import { pageStore } from './pageStore'

/** Whether the tool follows the handle, or an arm that floats is pushed towards it. */
export type HandleMode = HandleStatus['mode']

interface GripStore extends Omit<HandleStatus, 'k'> {
  /** Why the last pull did nothing; empty where it did. */
  readonly refused: string
}

const NONE: GripStore = { arm: '', mode: 'move', pulled: false, refused: '' }
export const useHandleDrag = pageStore<GripStore>(() => NONE)

/** Show a handle at this arm's tool, for operators; empty takes it away. */
export function showHandle(arm: string, mode: HandleMode = 'move'): void {
  if (arm) {
    connection.getState().take(arm, mode)
    return
  }
  connection.getState().close()
  useHandleDrag.setState(NONE)
}

/** The view says that the mouse is down in it; it says so every 50 ms as long as that is so. */
export function sendDragKeepAlive(): void {
  connection.getState().keepAlive()
}

/** The connection of the handle. */
class Connection {
  private socket: WebSocket | undefined

  take(arm: string, mode: HandleMode): void {
    const words = JSON.stringify({ k: 'take', arm, mode })
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(words)
    else this.open(words)
  }

  keepAlive(): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send('{"k":"held"}')
  }

  close(): void {
    const { socket } = this
    this.socket = undefined
    socket?.close()
  }

  private open(first: string): void {
    this.close()
    const opened = openSocket(`/cell/grip/${PAGE}`)
    this.socket = opened
    opened.onopen = () => opened.send(first)
    opened.onmessage = (message: MessageEvent<string>) => {
      if (this.socket === opened) hear(JSON.parse(message.data) as HandleStatus | RefusedFrame)
    }
    opened.onclose = () => {
      if (this.socket !== opened) return
      this.socket = undefined
      useHandleDrag.setState(NONE)
    }
  }
}

const connection = pageStore(
  () => new Connection(),
  (ended) => ended.close(),
)

function hear(frame: HandleStatus | RefusedFrame): void {
  if (frame.k === 'refused') {
    useHandleDrag.setState({ refused: frame.hint ? `${frame.message}: ${frame.hint}` : frame.message })
    return
  }
  const { arm, mode, pulled } = frame
  useHandleDrag.setState(pulled || arm !== useHandleDrag.getState().arm ? { arm, mode, pulled, refused: '' } : { arm, mode, pulled })
}

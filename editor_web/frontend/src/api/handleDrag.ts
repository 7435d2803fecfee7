/** The handle at an arm in the 3D view of this page: over a connection of its own, with which it ends.
 *
 * The arm follows only while the mouse is down in the view and this page passes that on, every 50 ms: neither says so in
 * the other's name, so an arm rests when either of them hangs.
 */
import { create } from 'zustand'
import { PAGE } from './layerGroups'
import { openSocket } from './socket'
import type { HandleStatus, RefusedFrame } from './types'

/** Whether the tool follows the handle, or an arm that floats is pushed towards it. */
export type HandleMode = HandleStatus['mode']

interface GripStore extends Omit<HandleStatus, 'k'> {
  /** Why the last pull did nothing; empty where it did. */
  readonly refused: string
}

const NONE: GripStore = { arm: '', mode: 'move', pulled: false, refused: '' }
export const useHandleDrag = create<GripStore>(() => NONE)

let socket: WebSocket | undefined

/** Show a handle at this arm's tool, for operators; empty takes it away. */
export function showHandle(arm: string, mode: HandleMode = 'move'): void {
  if (!arm) {
    socket?.close()
    socket = undefined
    useHandleDrag.setState(NONE)
    return
  }
  const send = () => socket?.send(JSON.stringify({ k: 'take', arm, mode }))
  if (socket?.readyState === WebSocket.OPEN) send()
  else open(send)
}

/** The view says that the mouse is down in it; it says so every 50 ms as long as that is so. */
export function sendDragKeepAlive(): void {
  if (socket?.readyState === WebSocket.OPEN) socket.send('{"k":"held"}')
}

function open(then: () => void): void {
  socket?.close()
  const opened = openSocket(`/cell/grip/${PAGE}`)
  socket = opened
  opened.onopen = then
  opened.onmessage = (message: MessageEvent<string>) => {
    const frame = JSON.parse(message.data) as HandleStatus | RefusedFrame
    if (frame.k === 'refused') {
      useHandleDrag.setState({ refused: frame.hint ? `${frame.message}: ${frame.hint}` : frame.message })
      return
    }
    const { arm, mode, pulled } = frame
    useHandleDrag.setState(pulled || arm !== useHandleDrag.getState().arm ? { arm, mode, pulled, refused: '' } : { arm, mode, pulled })
  }
  opened.onclose = () => {
    if (socket !== opened) return
    socket = undefined
    useHandleDrag.setState(NONE)
  }
}

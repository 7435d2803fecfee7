/** Drawing an arrow: let go over nothing, it asks what is to be there. */
import { useCallbackRef } from '@mantine/hooks'
import { useReactFlow, type FinalConnectionState } from '@xyflow/react'
import { useState } from 'react'
import { positionIn, type DrawnCanvas } from './canvasPlaces'
import { openPortPalette } from './paletteRequests'
import { parentPath } from '../../document/path'

export interface CanvasConnect {
  readonly isConnecting: boolean
  readonly onConnectStart: () => void
  readonly onConnectEnd: (event: MouseEvent | TouchEvent, state: FinalConnectionState) => void
}

export function useCanvasConnect(canvas: DrawnCanvas): CanvasConnect {
  const { screenToFlowPosition } = useReactFlow()
  const [isConnecting, setConnecting] = useState(false)
  const onConnectStart = useCallbackRef(() => setConnecting(true))
  const onConnectEnd = useCallbackRef((event: MouseEvent | TouchEvent, state: FinalConnectionState): void => {
    setConnecting(false)
    if (state.isValid || !state.fromNode || !state.fromHandle?.id || state.fromHandle.type !== 'source') return
    const point = 'changedTouches' in event ? event.changedTouches[0] : event
    if (!point) return
    const screen = { x: point.clientX, y: point.clientY }
    const at = positionIn(canvas, parentPath(state.fromNode.id), screenToFlowPosition(screen))
    openPortPalette(state.fromNode.id, state.fromHandle.id, screen, at)
  })
  return { isConnecting, onConnectStart, onConnectEnd }
}

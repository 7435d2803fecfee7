/** Which part of the canvas is seen when all of it is to be seen, arrows included. */
import { getViewportForBounds, type Viewport } from '@xyflow/react'
import type { Arrangement } from '../../document/editing/arrange'
import type { Box, Size } from '../../document/geometry'
import { canvasBoxes } from './canvasPositions'

export const LEAST = 0.03
const MOST = 1.1
/** Above there is room for the tools of a chosen node. */
const PADDING = { top: '56px', right: '40px', bottom: '36px', left: '40px' } as const

type Drawn = Pick<Arrangement, 'boxes' | 'outer' | 'routes'>

export function viewportFor(arrangement: Drawn, pane: Size): Viewport {
  const bounds = boundsOf(arrangement)
  if (!bounds) return { x: pane.width / 3, y: pane.height / 3, zoom: 1 }
  return getViewportForBounds(bounds, pane.width, pane.height, LEAST, MOST, PADDING)
}

/** Is nothing beyond the edges of the pane? */
export function isAllSeen(arrangement: Drawn, { x, y, zoom }: Viewport, pane: Size): boolean {
  const bounds = boundsOf(arrangement)
  if (!bounds) return true
  const left = bounds.x * zoom + x
  const top = bounds.y * zoom + y
  return left >= 0 && top >= 0 && left + bounds.width * zoom <= pane.width && top + bounds.height * zoom <= pane.height
}

function boundsOf(arrangement: Drawn): Box | undefined {
  const points = [
    ...[...arrangement.routes.values()].flat(),
    ...[...arrangement.boxes]
      .filter(([id]) => arrangement.outer.has(id))
      .flatMap(([, box]) => [box, { x: box.x + box.width, y: box.y + box.height }]),
  ]
  if (points.length === 0) return undefined
  const x = Math.min(...points.map((point) => point.x))
  const y = Math.min(...points.map((point) => point.y))
  return {
    x,
    y,
    width: Math.max(...points.map((point) => point.x)) - x,
    height: Math.max(...points.map((point) => point.y)) - y,
  }
}

/** All that is drawn now, in the pane it is drawn in. */
export function wholeCanvas(): Viewport {
  const pane = document.querySelector('[data-canvas]')?.getBoundingClientRect()
  return viewportFor(canvasBoxes(), { width: pane?.width ?? 1, height: pane?.height ?? 1 })
}

/** The canvas of recorded curves: a press goes to a time, the wheel and keys zoom, a drag with Shift pans. */
import { useElementSize, useMergedRef } from '@mantine/hooks'
import { useEffect, useRef, type KeyboardEvent, type PointerEvent, type RefObject } from 'react'
import type { Curves } from '../../document/curves'
import type { View } from '../../document/timeline'
import { actOn, useWheelZoom } from './canvasInput'
import { draw, LEFT_PX, RIGHT_PX, timeAt, type Curve } from './draw'
import { lookOf, sized } from './PlotCanvas'
import classes from './plots.module.css'

interface RecordedCanvasProps {
  readonly canvas: RefObject<HTMLCanvasElement | null>
  readonly curves: Curves
  readonly shown: readonly Curve[]
  readonly view: View
  readonly cursorS: number | undefined
  /** Where the axis of time begins, where something else has the same axis. */
  readonly leftPx?: number
  readonly onGo: (timeS: number) => void
  readonly onZoom: (factor: number, aroundS: number) => void
  readonly onPan: (byS: number) => void
  readonly onWidth: (width: number) => void
}

export function RecordedCanvas(props: RecordedCanvasProps) {
  const { canvas, curves, shown, view, cursorS, leftPx = LEFT_PX, onGo, onZoom, onPan, onWidth } = props
  const { ref: sizeRef, width, height } = useElementSize<HTMLDivElement>()
  const area = useRef<HTMLDivElement>(null)
  const both = useMergedRef(sizeRef, area)
  const grip = useRef<number>(undefined)
  const seen = { endS: view.untilS, spanS: view.untilS - view.fromS, leftPx }
  const { endS, spanS } = seen

  useEffect(() => onWidth(width), [width, onWidth])
  useEffect(() => {
    const frame = requestAnimationFrame(() => {
      const pen = canvas.current && sized(canvas.current, width, height)
      if (pen && area.current)
        draw(pen, { width, height }, curves, shown, { endS, spanS, atS: cursorS, isRecorded: true, leftPx }, lookOf(area.current))
    })
    return () => cancelAnimationFrame(frame)
  }, [canvas, width, height, curves, shown, endS, spanS, cursorS, leftPx])

  useWheelZoom(area, (factor, x) => onZoom(factor, timeAt(x, width, seen)))

  function at(event: PointerEvent<HTMLDivElement>): number {
    return event.clientX - event.currentTarget.getBoundingClientRect().left
  }

  function press(event: PointerEvent<HTMLDivElement>): void {
    event.currentTarget.setPointerCapture(event.pointerId)
    grip.current = at(event)
    if (!event.shiftKey) onGo(timeAt(at(event), width, seen))
  }

  function move(event: PointerEvent<HTMLDivElement>): void {
    if (grip.current === undefined) return
    const x = at(event)
    if (event.shiftKey) onPan(((grip.current - x) / (width - leftPx - RIGHT_PX)) * spanS)
    else onGo(timeAt(x, width, seen))
    grip.current = x
  }

  function key(event: KeyboardEvent): void {
    const here = cursorS ?? endS
    actOn(event, {
      ArrowLeft: () => onGo(here - spanS / 100),
      ArrowRight: () => onGo(here + spanS / 100),
      PageUp: () => onPan(-spanS / 2),
      PageDown: () => onPan(spanS / 2),
      '+': () => onZoom(0.8, here),
      '-': () => onZoom(1.25, here),
      '0': () => onZoom(Infinity, here),
    })
  }

  return (
    <div
      className={classes.canvas}
      ref={both}
      role="slider"
      tabIndex={0}
      aria-valuemin={view.fromS}
      aria-valuemax={view.untilS}
      aria-valuenow={cursorS ?? view.untilS}
      aria-valuetext={`${(cursorS ?? view.untilS).toFixed(2)} s`}
      aria-label={`${shown.length} recorded curves from ${view.fromS.toFixed(2)} to ${view.untilS.toFixed(2)} s`}
      title="Drag to see a moment of the past; turn the wheel to zoom"
      onPointerDown={press}
      onPointerMove={move}
      onPointerUp={() => (grip.current = undefined)}
      onPointerCancel={() => (grip.current = undefined)}
      onKeyDown={key}
    >
      <canvas ref={canvas} aria-hidden />
    </div>
  )
}

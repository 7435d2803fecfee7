/** The canvas of the curves: drawn when something has come, zoomed by wheel or keys, panned by dragging. */
import { tokensOf } from '../../components/tokens'
import { useElementSize, useMergedRef } from '@mantine/hooks'
import { useEffect, useRef, type KeyboardEvent, type PointerEvent, type RefObject } from 'react'
import { actOn, useWheelZoom } from './canvasInput'
import { draw, LEFT_PX, RIGHT_PX, timeAt, type Curve, type Look } from './draw'
import type { Plot } from './usePlot'
import classes from './plots.module.css'

interface PlotCanvasProps {
  readonly canvas: RefObject<HTMLCanvasElement | null>
  readonly plot: Plot
  readonly curves: readonly Curve[]
  readonly atS: number | undefined
  readonly onPoint: (atS: number | undefined) => void
}

export function PlotCanvas({ canvas, plot, curves, atS, onPoint }: PlotCanvasProps) {
  const { ref: sizeRef, width, height } = useElementSize<HTMLDivElement>()
  const area = useRef<HTMLDivElement>(null)
  const drag = useRef<{ readonly x: number; readonly endS: number }>(undefined)
  const both = useMergedRef(sizeRef, area)
  const samples = plot.curves
  const endS = plot.pausedS ?? (samples.length > 0 ? samples.time(samples.length - 1) : 0)
  const { spanS } = plot

  useEffect(() => {
    const frame = requestAnimationFrame(() => {
      const pen = canvas.current && sized(canvas.current, width, height)
      if (pen && area.current) draw(pen, { width, height }, samples, curves, { endS, spanS, atS }, lookOf(area.current))
    })
    return () => cancelAnimationFrame(frame)
  }, [canvas, width, height, samples, curves, endS, spanS, atS, plot.revision])

  useWheelZoom(area, (factor) => plot.zoom(spanS * factor))

  function move(event: PointerEvent<HTMLDivElement>): void {
    const x = event.clientX - event.currentTarget.getBoundingClientRect().left
    if (drag.current) {
      const moved = ((x - drag.current.x) / (width - LEFT_PX - RIGHT_PX)) * spanS
      if (plot.pausedS !== undefined || Math.abs(x - drag.current.x) > 4) plot.panTo(drag.current.endS - moved)
    }
    onPoint(x >= LEFT_PX && x <= width - RIGHT_PX ? timeAt(x, width, { endS, spanS }) : undefined)
  }

  function press(event: KeyboardEvent): void {
    const step = spanS / 40
    actOn(event, {
      ArrowLeft: () => onPoint((atS ?? endS) - step),
      ArrowRight: () => onPoint(Math.min(endS, (atS ?? endS) + step)),
      '+': () => plot.zoom(spanS * 0.8),
      '-': () => plot.zoom(spanS * 1.25),
      ' ': () => (plot.pausedS === undefined ? plot.pause() : plot.goOn()),
      PageUp: () => plot.panTo(endS - spanS / 2),
      PageDown: () => plot.panTo(endS + spanS / 2),
      Escape: () => onPoint(undefined),
    })
  }

  return (
    // oxlint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- a picture that is read by the keyboard
    <div
      className={classes.canvas}
      ref={both}
      role="img"
      tabIndex={0}
      aria-label={`${curves.length} curves over ${Math.round(spanS)} s; arrows read values, plus and minus zoom, space pauses`}
      onPointerMove={move}
      onPointerLeave={() => !drag.current && onPoint(undefined)}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId)
        drag.current = { x: event.clientX - event.currentTarget.getBoundingClientRect().left, endS }
      }}
      onPointerUp={() => (drag.current = undefined)}
      onPointerCancel={() => (drag.current = undefined)}
      onKeyDown={press}
    >
      <canvas ref={canvas} aria-hidden />
    </div>
  )
}

/** The pen of a canvas in CSS pixels, sharp on every screen. */
export function sized(canvas: HTMLCanvasElement, width: number, height: number): CanvasRenderingContext2D | null {
  const scale = window.devicePixelRatio || 1
  const [wide, high] = [Math.round(width * scale), Math.round(height * scale)]
  if (canvas.width !== wide || canvas.height !== high) {
    canvas.width = wide
    canvas.height = high
  }
  const pen = canvas.getContext('2d')
  pen?.setTransform(scale, 0, 0, scale, 0, 0)
  return pen
}

export function lookOf(element: HTMLElement): Look {
  const token = tokensOf(element)
  return {
    text: token('quiet'),
    line: token('line'),
    colors: Array.from({ length: 8 }, (_, index) => token(`curve-${index}`)),
    font: `11px ${getComputedStyle(element).fontFamily}`,
  }
}

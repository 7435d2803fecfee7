/** Pointer and wheel on a timeline: one pointer goes to a time, two zoom and pan, the wheel zooms or scrolls. */
import { useRef, type PointerEvent, type RefObject, type WheelEvent } from 'react'
import { timeAt, type View } from '../../document/timeline'

interface GesturesProps {
  readonly view: View
  readonly width: number
  /** The time that is meant by a press at a time. */
  readonly snapped: (timeS: number) => number
  readonly onGo: (timeS: number) => void
  readonly onZoom: (factor: number, aroundS: number) => void
  readonly onPan: (byS: number) => void
  /** The pointer is at a place of the head or of the bars, in pixels of that. */
  readonly onHover: (x: number, y: number, isHead: boolean) => void
  readonly onLeave: () => void
}

const WHEEL = 0.0015

export function useGestures({ view, width, snapped, onGo, onZoom, onPan, onHover, onLeave }: GesturesProps) {
  const pointers = useRef(new Map<number, number>())
  const isPanning = useRef(false)
  const secondsPerPx = (view.untilS - view.fromS) / Math.max(width, 1)

  function onPointerDown(event: PointerEvent<HTMLElement>): void {
    if (event.button > 1) return
    event.currentTarget.setPointerCapture(event.pointerId)
    const x = xIn(event)
    pointers.current.set(event.pointerId, x)
    isPanning.current = event.button === 1 || event.shiftKey
    if (pointers.current.size === 1 && !isPanning.current) onGo(snapped(timeAt(view, width, x)))
  }

  function onPointerMove(event: PointerEvent<HTMLElement>, isHead: boolean): void {
    const x = xIn(event)
    const before = pointers.current.get(event.pointerId)
    if (before === undefined) {
      onHover(x, event.clientY - event.currentTarget.getBoundingClientRect().top, isHead)
      return
    }
    onLeave()
    pointers.current.set(event.pointerId, x)
    const other = [...pointers.current].find(([id]) => id !== event.pointerId)?.[1]
    if (other !== undefined) {
      const [apart, apartBefore] = [Math.abs(x - other), Math.abs(before - other)]
      onZoom(Math.max(apartBefore, 8) / Math.max(apart, 8), timeAt(view, width, (x + other) / 2))
    } else if (isPanning.current) onPan((before - x) * secondsPerPx)
    else onGo(timeAt(view, width, x))
  }

  function onPointerEnd(event: PointerEvent<HTMLElement>): void {
    pointers.current.delete(event.pointerId)
  }

  function onWheel(event: WheelEvent<HTMLElement>, scroller: HTMLElement | null): void {
    const along = event.shiftKey ? event.deltaX + event.deltaY : event.deltaX
    if (Math.abs(along) > Math.abs(event.shiftKey ? 0 : event.deltaY)) onPan(along * secondsPerPx)
    // A pinch on a touch pad comes as a wheel with Ctrl.
    else if (event.ctrlKey || scroller === null || scroller.scrollHeight <= scroller.clientHeight) {
      onZoom(Math.exp(event.deltaY * WHEEL * (event.ctrlKey ? 6 : 1)), timeAt(view, width, xIn(event)))
    } else scroller.scrollTop += event.deltaY
  }

  const common = { onPointerDown, onPointerUp: onPointerEnd, onPointerCancel: onPointerEnd, onPointerLeave: onLeave }
  return {
    head: {
      ...common,
      onPointerMove: (event: PointerEvent<HTMLElement>) => onPointerMove(event, true),
      onWheel: (event: WheelEvent<HTMLElement>) => onWheel(event, null),
    },
    bars: (scroller: RefObject<HTMLElement | null>) => ({
      ...common,
      onPointerMove: (event: PointerEvent<HTMLElement>) => onPointerMove(event, false),
      onWheel: (event: WheelEvent<HTMLElement>) => onWheel(event, scroller.current),
    }),
  }
}

function xIn(event: { readonly clientX: number; readonly currentTarget: HTMLElement }): number {
  return event.clientX - event.currentTarget.getBoundingClientRect().left
}

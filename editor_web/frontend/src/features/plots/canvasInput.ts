/** What wheel and keys do on a canvas of curves. */
import { useEffect, useRef, type KeyboardEvent, type RefObject } from 'react'

/** Hear the wheel over an element: by how much it changes the span, and where it is turned. */
export function useWheelZoom(area: RefObject<HTMLElement | null>, onZoom: (factor: number, x: number) => void): void {
  const zoom = useRef(onZoom)
  useEffect(() => {
    zoom.current = onZoom
  })
  useEffect(() => {
    const element = area.current
    // React's own wheel listener cannot keep the page from scrolling.
    const turn = (event: WheelEvent) => {
      event.preventDefault()
      zoom.current(event.deltaY > 0 ? 1.25 : 0.8, event.offsetX)
    }
    element?.addEventListener('wheel', turn, { passive: false })
    return () => element?.removeEventListener('wheel', turn)
  }, [area])
}

/** Do what a key means here, and nothing else; other keys keep their meaning. */
export function actOn(event: KeyboardEvent, actions: Readonly<Record<string, () => void>>): void {
  const act = actions[event.key]
  if (!act) return
  event.preventDefault()
  event.stopPropagation()
  act()
}

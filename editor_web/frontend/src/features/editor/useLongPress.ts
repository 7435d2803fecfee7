/** A finger that rests on a free place of the canvas means what the right button of a mouse does; not every browser says so itself. */
import { useEffect, type RefObject } from 'react'

const REST_MS = 550
/** A finger is never quite still. */
const STILL_PX = 10

export function useLongPress(area: RefObject<HTMLElement | null>): void {
  useEffect(() => {
    const here = area.current
    if (!here) return
    let timer: ReturnType<typeof setTimeout> | undefined
    let start: PointerEvent | undefined
    const end = () => {
      clearTimeout(timer)
      start = undefined
    }
    const onDown = (event: PointerEvent) => {
      const isAlone = start === undefined
      end()
      const pane = event.target instanceof Element ? event.target.closest('.react-flow__pane') : null
      // With a second finger the canvas is zoomed.
      if (event.pointerType !== 'touch' || !isAlone || !pane) return
      start = event
      timer = setTimeout(() => {
        const { clientX, clientY } = event
        end()
        swallowClick()
        pane.dispatchEvent(new MouseEvent('contextmenu', { bubbles: true, cancelable: true, clientX, clientY }))
      }, REST_MS)
    }
    const onMove = (event: PointerEvent) => {
      if (start && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) > STILL_PX) end()
    }
    const onMenu = (event: Event) => {
      if (event.isTrusted) end()
    }
    here.addEventListener('pointerdown', onDown, true)
    addEventListener('pointermove', onMove, true)
    addEventListener('pointerup', end, true)
    addEventListener('pointercancel', end, true)
    here.addEventListener('contextmenu', onMenu, true)
    return () => {
      end()
      here.removeEventListener('pointerdown', onDown, true)
      removeEventListener('pointermove', onMove, true)
      removeEventListener('pointerup', end, true)
      removeEventListener('pointercancel', end, true)
      here.removeEventListener('contextmenu', onMenu, true)
    }
  }, [area])
}

/** When the finger is lifted, the click that follows means nothing any more. */
function swallowClick(): void {
  const swallow = (event: Event) => {
    event.preventDefault()
    event.stopPropagation()
  }
  addEventListener('click', swallow, { capture: true, once: true })
  addEventListener('pointerup', () => setTimeout(() => removeEventListener('click', swallow, { capture: true }), 400), {
    capture: true,
    once: true,
  })
}

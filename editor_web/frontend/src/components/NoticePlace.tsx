/** Where notices come up and go away without moving what the pointer is on. */
import { Box } from '@mantine/core'
import { useEffect, useRef, useState, type ReactNode } from 'react'

/** No higher than the head of a page and the commands of a run: questions of a run lie below and stay in reach. */
const OVERLAY_MAX = '6.25rem'
/** Wide pages have their commands at the end of their head. */
const OVERLAY_END = { base: 0, md: '28rem' }

/**
 * The room of the notices follows their height only while the pointer is elsewhere; until then they lie over what is below,
 * or leave their room empty. What is below is all else in the parent of this place.
 */
export function NoticePlace({ children }: { readonly children: ReactNode }) {
  const place = useRef<HTMLDivElement>(null)
  const notices = useRef<HTMLDivElement>(null)
  const [heightPx, setHeight] = useState(0)
  const [roomPx, setRoom] = useState(0)
  const isOver = useIsPointerInside(place)
  useEffect(() => {
    const shown = notices.current
    if (!shown) return
    const observer = new ResizeObserver(() => setHeight(shown.offsetHeight))
    observer.observe(shown)
    return () => observer.disconnect()
  }, [])
  useEffect(() => {
    if (!isOver) setRoom(heightPx)
  }, [isOver, heightPx])
  const isOverlay = isOver && heightPx > roomPx
  return (
    <Box ref={place} pos="relative" flex="none" style={{ height: roomPx, zIndex: 30 }} data-overlay={isOverlay || undefined}>
      <Box
        pos="absolute"
        top={0}
        left={0}
        right={isOverlay ? OVERLAY_END : 0}
        bg="var(--surface)"
        style={isOverlay ? { maxHeight: OVERLAY_MAX, overflowY: 'auto', boxShadow: 'var(--mantine-shadow-md)' } : {}}
      >
        <div ref={notices}>{children}</div>
      </Box>
    </Box>
  )
}

/** Is the pointer on the parent of the place, also where a notice lies over it? */
function useIsPointerInside(place: { readonly current: HTMLElement | null }): boolean {
  const [isInside, setInside] = useState(false)
  useEffect(() => {
    const onOver = ({ target }: PointerEvent) => {
      if (target instanceof Node) setInside(place.current?.parentElement?.contains(target) === true)
    }
    // A finger that is lifted, or a pointer that leaves the window, is on nothing.
    const onOut = (event: PointerEvent) => event.relatedTarget === null && setInside(false)
    document.addEventListener('pointerover', onOver)
    document.addEventListener('pointerout', onOut)
    return () => {
      document.removeEventListener('pointerover', onOver)
      document.removeEventListener('pointerout', onOut)
    }
  }, [place])
  return isInside
}

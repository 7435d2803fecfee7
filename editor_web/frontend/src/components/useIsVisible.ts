/** Whether a part of the page can be seen: not in a tab that is closed, not in a browser tab in the background. */
import { useEffect, useState, type RefObject } from 'react'

export function useIsVisible(part: RefObject<HTMLElement | null>): boolean {
  const [isShown, setShown] = useState(false)
  useEffect(() => {
    const element = part.current
    if (!element) return
    let isInside = false
    const update = () => setShown(isInside && document.visibilityState === 'visible')
    const observer = new IntersectionObserver((entries) => {
      isInside = entries.at(-1)?.isIntersecting ?? false
      update()
    })
    observer.observe(element)
    document.addEventListener('visibilitychange', update)
    return () => {
      observer.disconnect()
      document.removeEventListener('visibilitychange', update)
    }
  }, [part])
  return isShown
}

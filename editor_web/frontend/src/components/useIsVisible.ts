/** Whether a part of the page can be seen: not in a tab that is closed, not in a browser tab in the background. */
import { useEffect, useState, type RefObject } from 'react'

export function useIsVisible(part: RefObject<HTMLElement | null>): boolean {
  const [isShown, setShown] = useState(false)
  useEffect(() => {
    const element = part.current
    if (!element) return
    let isInside = false
    const tell = () => setShown(isInside && document.visibilityState === 'visible')
    const observer = new IntersectionObserver((entries) => {
      isInside = entries.at(-1)?.isIntersecting ?? false
      tell()
    })
    observer.observe(element)
    document.addEventListener('visibilitychange', tell)
    return () => {
      observer.disconnect()
      document.removeEventListener('visibilitychange', tell)
    }
  }, [part])
  return isShown
}

/** The address carries the moment and the node of the run that is looked at: `/runs/ID#t=12.4&node=root/grasp`. */
import { useEffect, useRef } from 'react'
import { seek, useTimeline, type Subject } from '../api/timeline'
import { momentOf, momentText } from '../document/moment'

const PATIENCE_MS = 200

/** Restore what the address names when a run is opened, and keep the address as the cursor and the selection are. */
export function useMomentAddress(subject: Subject | undefined, node: string | undefined, onNode: (path: string) => void): void {
  const timeS = useTimeline((s) => s.timeS)
  const show = useRef(onNode)
  useEffect(() => {
    show.current = onNode
  })
  const address = subject?.address
  useEffect(() => {
    if (!subject || !isOfRun()) return
    const place = momentOf(location.hash)
    if (place.node) show.current(place.node)
    if (place.timeS !== undefined) seek(subject, place.timeS)
    // oxlint-disable-next-line react/exhaustive-deps -- the address names the subject
  }, [address])
  useEffect(() => {
    if (address === undefined || !isOfRun()) return
    const timer = setTimeout(() => {
      const text = momentText(timeS, node)
      history.replaceState(null, '', `${location.pathname}${location.search}${text && `#${text}`}`)
    }, PATIENCE_MS)
    return () => clearTimeout(timer)
  }, [address, timeS, node])
}

/** The page of a behavior shows a run too, but its address names none. */
function isOfRun(): boolean {
  return /^\/(runs|recordings)\/./.test(location.pathname)
}

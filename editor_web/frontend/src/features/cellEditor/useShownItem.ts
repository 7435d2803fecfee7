/** Shows in the 3D view of this page where an item will be: its axes, and its body as a ghost. */
import { useEffect } from 'react'
import { connectTeach, useTeach } from '../../api/teaching'
import { showMarks } from '../../api/viewMarks'
import type { ShownItem } from '../../document/cellShown'

const PAUSE_MS = 60
const BY = 'item under edit'

/** With `warns` its body is red: it touches something. */
export function useShownItem(item: ShownItem | undefined, warns: boolean): void {
  useEffect(connectTeach, [])
  const isOpen = useTeach((s) => s.isOpen)
  const written = JSON.stringify(item ?? null)
  useEffect(() => {
    if (!isOpen) return
    const timer = setTimeout(() => show(JSON.parse(written) as ShownItem | null, warns), PAUSE_MS)
    return () => clearTimeout(timer)
  }, [isOpen, written, warns])
  useEffect(() => () => showMarks(BY, undefined), [])
}

function show(item: ShownItem | null, warns: boolean): void {
  if (!item) return showMarks(BY, undefined)
  const { pose, shape, size } = item
  const place = [pose.xyz, pose.xyzw] as const
  showMarks(BY, { axes: place, body: shape === undefined ? null : { shape, size_m: size, pose: place, warns } })
}

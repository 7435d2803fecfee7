/** Shows in the 3D view of this page where an item will be: its axes, and its body as a ghost. */
import { useEffect } from 'react'
import { connectTeach, sendToServer, useTeach } from '../../api/teaching'
import type { ShownItem } from '../../document/cellShown'

const PAUSE_MS = 60
const NO_MARKS = { k: 'mark', points: [], box: null, axes: null, body: null } as const

export function useShownItem(item: ShownItem | undefined): void {
  useEffect(connectTeach, [])
  const isOpen = useTeach((s) => s.isOpen)
  const written = JSON.stringify(item ?? null)
  useEffect(() => {
    if (!isOpen) return
    const timer = setTimeout(() => show(JSON.parse(written) as ShownItem | null), PAUSE_MS)
    return () => clearTimeout(timer)
  }, [isOpen, written])
  useEffect(() => () => sendToServer(NO_MARKS), [])
}

function show(item: ShownItem | null): void {
  if (!item) return sendToServer(NO_MARKS)
  const { pose, shape, size } = item
  const place = [pose.xyz, pose.xyzw] as const
  sendToServer({ ...NO_MARKS, axes: place, body: shape === undefined ? null : { shape, size_m: size, pose: place } })
}

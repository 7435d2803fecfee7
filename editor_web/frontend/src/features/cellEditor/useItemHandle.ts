/** A handle at an item in the 3D view of this page: a drag of it is told here, and moves nothing. */
import { useEffect, useEffectEvent } from 'react'
import { sendToServer, useTeach } from '../../api/teaching'
import type { PlacedPose } from '../../document/poses'

const PAUSE_MS = 60

/** `onDrag` is told each pose of the world that the handle is dragged to. Without a `pose` there is none. */
export function useItemHandle(pose: PlacedPose | undefined, turns: boolean, onDrag: (pose: PlacedPose) => void): void {
  const isOpen = useTeach((s) => s.isOpen)
  const placed = useTeach((s) => s.placed)
  // A handle under the mouse stays the one that it is; where it was let go, it is drawn at the snapped pose.
  const isHeld = placed !== undefined && placed.phase !== 'end'
  const written = JSON.stringify(pose ?? null)
  const report = useEffectEvent(onDrag)
  useEffect(() => {
    if (placed) report(placed)
  }, [placed])
  useEffect(() => {
    if (!isOpen || isHeld) return
    const timer = setTimeout(() => show(JSON.parse(written) as PlacedPose | null, turns), PAUSE_MS)
    return () => clearTimeout(timer)
    // oxlint-disable-next-line react/exhaustive-deps -- let go where it was before, it is drawn there again
  }, [isOpen, isHeld, written, turns, placed?.phase])
  useEffect(
    () => () => {
      show(null, false)
      useTeach.setState({ placed: undefined })
    },
    [],
  )
}

function show(pose: PlacedPose | null, turns: boolean): void {
  sendToServer({ k: 'place', at: pose && [pose.xyz, pose.xyzw], turns })
}

/** Plays the past: moves the cursor as fast as the run was, or some times as fast. */
import { useEffect } from 'react'
import { seek, useTimeline, type Subject } from '../../api/timeline'

export function usePlayback(subject: Subject | undefined, durationS: number): void {
  const isPlaying = useTimeline((s) => s.isPlaying)
  useEffect(() => {
    if (!isPlaying || !subject) return
    let before = performance.now()
    let frame = requestAnimationFrame(function advance(now) {
      const { timeS, speed } = useTimeline.getState()
      // The time of a frame may lie before the moment at which it was asked for.
      const next = (timeS ?? 0) + (Math.max(0, now - before) / 1000) * speed
      before = now
      seek(subject, Math.min(next, durationS))
      if (next >= durationS) useTimeline.setState({ isPlaying: false })
      else frame = requestAnimationFrame(advance)
    })
    return () => cancelAnimationFrame(frame)
  }, [isPlaying, subject, durationS])
}

/** Begin to play, from the beginning where the cursor is at the end. */
export function play(subject: Subject, durationS: number): void {
  const { timeS, isPlaying } = useTimeline.getState()
  if (!isPlaying && (timeS === undefined || timeS >= durationS)) seek(subject, 0)
  useTimeline.setState({ isPlaying: !isPlaying })
}

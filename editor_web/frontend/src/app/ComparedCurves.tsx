/** Recorded curves of two runs over one another, aligned at the start of a visit. */
import { useMemo } from 'react'
import { recordingSubject, runSubject } from '../api/timeline'
import type { Side } from '../document/comparison'
import { RecordedPlots } from '../features/plots/RecordedPlots'
import type { ComparedProps } from './ComparedCell'
import { isRecordingName } from './route'

export function ComparedCurves({ left, right, visit, durationS, cursorS, onGo }: ComparedProps) {
  const sources = useMemo(() => {
    const sourceOf = (side: Side, name: string) => {
      const startS = visit ? visit[side]?.start_s : 0
      return startS === undefined
        ? []
        : [{ address: (isRecordingName(name) ? recordingSubject(name, '') : runSubject(name)).address, label: side, startS }]
    }
    return [...sourceOf('left', left), ...sourceOf('right', right)]
  }, [left, right, visit])
  return <RecordedPlots sources={sources} durationS={durationS} cursorS={cursorS} onGo={onGo} />
}

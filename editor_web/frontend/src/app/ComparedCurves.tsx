/** Recorded curves of two runs over one another, aligned at the start of a visit. */
import { useMemo, useState } from 'react'
import { recordingSubject, runSubject } from '../api/timeline'
import type { AlignedVisit, RunComparison } from '../api/types'
import { durationOf, type Side } from '../document/comparison'
import { RecordedPlots } from '../features/plots/RecordedPlots'
import { isRecordingName } from './route'

interface ComparedCurvesProps {
  readonly left: string
  readonly right: string
  readonly found: RunComparison
  /** Undefined aligns the runs at their starts. */
  readonly visit: AlignedVisit | undefined
}

/** A visit of no length still has something to see around it. */
const SHORTEST_S = 0.5

export function ComparedCurves({ left, right, found, visit }: ComparedCurvesProps) {
  const [cursorS, setCursor] = useState<number>()
  const sources = useMemo(() => {
    const sourceOf = (side: Side, name: string) => {
      const startS = visit ? visit[side]?.start_s : 0
      return startS === undefined
        ? []
        : [{ address: (isRecordingName(name) ? recordingSubject(name, '') : runSubject(name)).address, label: side, startS }]
    }
    return [...sourceOf('left', left), ...sourceOf('right', right)]
  }, [left, right, visit])
  const lengths = visit ? [durationOf(visit.left), durationOf(visit.right)] : [found.left.duration_s, found.right.duration_s]
  return (
    <RecordedPlots
      sources={sources}
      durationS={Math.max(SHORTEST_S, ...lengths.map((length) => length ?? 0))}
      cursorS={cursorS}
      onGo={setCursor}
    />
  )
}

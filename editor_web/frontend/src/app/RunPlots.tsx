/** Plots of a run: live numbers, and while its past is shown those of its recording, with the cursor of the timeline. */
import { useMemo } from 'react'
import { runSubject, seek, useTimeline } from '../api/timeline'
import type { RunView } from '../api/types'
import { Plots } from '../features/plots/Plots'
import { RecordedPlots } from '../features/plots/RecordedPlots'

export function RunPlots({ run }: { readonly run: RunView | undefined }) {
  const opened = useTimeline((s) => s.opened)
  const timeS = useTimeline((s) => s.timeS)
  const knownS = useTimeline((s) => s.course?.durationS)
  const id = run?.id
  const isPast = timeS !== undefined
  const subject = useMemo(() => opened ?? (id !== undefined && isPast ? runSubject(id) : undefined), [opened, id, isPast])
  const sources = useMemo(() => (subject ? [{ address: subject.address, label: '', startS: 0 }] : []), [subject])
  if (!subject) return <Plots />
  const durationS = Math.max(knownS ?? run?.duration_s ?? 0, timeS ?? 0)
  return <RecordedPlots sources={sources} durationS={durationS} cursorS={timeS ?? durationS} onGo={(at) => seek(subject, at)} />
}

/** What the timeline is of: the past run or recording that is opened, else the run that the page shows. */
import { useEffect, useMemo } from 'react'
import { streamedSeq, useLive } from '../../api/live'
import { forget, refresh, runSubject, useTimeline, type Subject } from '../../api/timeline'
import type { RunView } from '../../api/types'
import { isActive } from '../../document/runState'

export function useSubject(run: RunView | undefined): Subject | undefined {
  const opened = useTimeline((s) => s.opened)
  const id = run?.id
  return useMemo(() => opened ?? (id ? runSubject(id) : undefined), [opened, id])
}

const PERIOD_MS = 400

/** Keep the timeline up to date while it is seen. */
export function useRunUpdates(subject: Subject | undefined, run: RunView | undefined, isShown: boolean): void {
  const generation = useLive((s) => s.generation)
  const goesOn = isActive(run) && !subject?.isPast
  useEffect(() => forget, [subject?.address, generation])
  useEffect(() => {
    if (!subject || !isShown) return
    let isOver = false
    let timer: ReturnType<typeof setTimeout>
    async function follow(of: Subject): Promise<void> {
      const known = useTimeline.getState().course
      if (!known || known.run !== of.run || streamedSeq() > known.seq) await refresh(of)
      if (!isOver && goesOn) timer = setTimeout(() => void follow(of), PERIOD_MS)
    }
    void follow(subject)
    return () => {
      isOver = true
      clearTimeout(timer)
    }
  }, [subject, isShown, goesOn, generation])
}

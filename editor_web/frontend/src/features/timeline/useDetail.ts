/** The spans to draw: all of them, or, where those of a long run are merged, exactly those of the part that is seen. */
import { skipToken, useQuery } from '@tanstack/react-query'
import { useEffect, useMemo, useState } from 'react'
import { pastQueries, runSubject, type Subject } from '../../api/timeline'
import type { ActivationInterval } from '../../api/types'
import type { LoadedTimeline, View } from '../../document/timeline'

const PATIENCE_MS = 150

interface Part extends View {
  readonly subject: Subject
  /** Up to which event the timeline was known. */
  readonly seq: number
}

export function useDetail(
  subject: Subject | undefined,
  course: LoadedTimeline | undefined,
  view: View,
  isPart: boolean,
): ReadonlyMap<string, readonly ActivationInterval[]> {
  const [asked, ask] = useState<Part>()
  const detail = useLoaded(asked)
  const isNeeded = isPart && course?.merged === true && subject !== undefined
  const { fromS, untilS } = view
  const fits = detail !== undefined && isNeeded && covers(detail, subject, view) && detail.seq === course.seq
  useEffect(() => {
    if (!isNeeded || fits) return
    const length = untilS - fromS
    const part = { subject, fromS: Math.max(0, fromS - length / 2), untilS: untilS + length / 2, seq: course.seq }
    const timer = setTimeout(() => ask(part), PATIENCE_MS)
    return () => clearTimeout(timer)
  }, [isNeeded, fits, fromS, untilS, subject, course?.seq])
  return fits ? detail.rows : (course?.rows ?? new Map<string, readonly ActivationInterval[]>())
}

interface Detail extends Part {
  readonly rows: ReadonlyMap<string, readonly ActivationInterval[]>
}

function covers(detail: Detail, subject: Subject, { fromS, untilS }: View): boolean {
  return detail.subject === subject && detail.fromS <= fromS && detail.untilS >= untilS
}

/** Undefined until it is there, and where it cannot be had: what is there already is good enough to go on with. */
function useLoaded(asked: Part | undefined): Detail | undefined {
  const { subject, fromS = 0, untilS = 0, seq = 0 } = asked ?? {}
  const query = pastQueries.part(subject ?? runSubject(''), fromS, untilS, seq)
  const { data } = useQuery({ ...query, ...(!subject && { queryFn: skipToken }) })
  return useMemo(() => {
    if (!asked || !data) return undefined
    return { ...asked, seq: data.seq, rows: new Map(data.rows.map((row) => [row.path, row.spans])) }
  }, [asked, data])
}

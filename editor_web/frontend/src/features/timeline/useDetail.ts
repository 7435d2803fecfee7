/** The spans to draw: all of them, or, where those of a long run are merged, exactly those of the part that is seen. */
import { useEffect, useState } from 'react'
import { pastApi, type Subject } from '../../api/timeline'
import type { ActivationInterval } from '../../api/types'
import type { LoadedTimeline, View } from '../../document/timeline'

const PATIENCE_MS = 150

interface Detail extends View {
  readonly seq: number
  readonly rows: ReadonlyMap<string, readonly ActivationInterval[]>
}

export function useDetail(
  subject: Subject | undefined,
  course: LoadedTimeline | undefined,
  view: View,
  isPart: boolean,
): ReadonlyMap<string, readonly ActivationInterval[]> {
  const [detail, setDetail] = useState<Detail>()
  const isNeeded = isPart && course?.merged === true && subject !== undefined
  const { fromS, untilS } = view
  const fits = detail !== undefined && isNeeded && detail.fromS <= fromS && detail.untilS >= untilS && detail.seq === course.seq
  useEffect(() => {
    if (!isNeeded || fits) return
    let isOver = false
    const length = untilS - fromS
    const [wideFromS, wideUntilS] = [Math.max(0, fromS - length / 2), untilS + length / 2]
    const timer = setTimeout(() => {
      pastApi.timeline(subject, 0, wideFromS, wideUntilS).then(
        (loaded) => {
          if (isOver) return
          setDetail({
            fromS: wideFromS,
            untilS: wideUntilS,
            seq: loaded.seq,
            rows: new Map(loaded.rows.map((row) => [row.path, row.spans])),
          })
        },
        // What is there already is good enough to go on with.
        () => undefined,
      )
    }, PATIENCE_MS)
    return () => {
      isOver = true
      clearTimeout(timer)
    }
  }, [isNeeded, fits, fromS, untilS, subject, course?.seq])
  return fits ? detail.rows : (course?.rows ?? new Map<string, readonly ActivationInterval[]>())
}

/** A trend in words. Pure. */
import type { RunTrend } from '../../api/types'

/** `17 of 20 runs succeeded, 2 failed, 1 stopped; the latest of 53`: each run is counted once. */
export function countText({ runs, succeeded, failed, stopped, not_ended, known }: RunTrend): string {
  const others = [
    [failed, 'failed'],
    [stopped, 'stopped'],
    [not_ended, 'not ended'],
  ] as const
  const counts = [
    `${succeeded} of ${runs.length} runs succeeded`,
    ...others.flatMap(([count, word]) => (count > 0 ? [`${count} ${word}`] : [])),
  ]
  return counts.join(', ') + (known > runs.length ? `; the latest of ${known}` : '')
}

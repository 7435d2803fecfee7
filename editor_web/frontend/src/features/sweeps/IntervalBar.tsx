/** A rate from 0 to 1 with its interval, as a line with a dot; the numbers stand beside it. */
import type { Interval } from '../../api/types'
import classes from './bars.module.css'

export interface IntervalBarProps {
  readonly interval: Interval
  readonly rate: number
  readonly isBad?: boolean
}

export function IntervalBar({ interval: [low, high], rate, isBad = false }: IntervalBarProps) {
  return (
    <span className={classes.bar} data-bad={isBad || undefined} aria-hidden>
      <span style={{ left: `${100 * low}%`, width: `${100 * (high - low)}%` }} />
      <span className={classes.mark} data-dot style={{ left: `${100 * rate}%` }} />
    </span>
  )
}

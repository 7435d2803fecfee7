/** How the interval of the success rate has narrowed over the runs, with the required rate as a line. */
import { Group, Text } from '@mantine/core'
import { useElementSize } from '@mantine/hooks'
import { useId, type ReactNode } from 'react'
import type { CurvePoint } from '../../api/types'
import { intervalText, percent } from '../../document/sweeps'
import classes from './drawings.module.css'

const HEIGHT = 210
const LEFT = 52
const RIGHT = 14
const TOP = 12
const BOTTOM = 28
const LINES = 5

export interface RateCurveProps {
  readonly curve: readonly CurvePoint[]
  readonly required: number | undefined
}

export function RateCurve({ curve, required }: RateCurveProps) {
  const { ref, width } = useElementSize()
  const clip = useId()
  const last = curve.at(-1)
  if (!last)
    return (
      <Text inherit c="dimmed">
        The curve begins with the first run.
      </Text>
    )
  const wide = Math.max(width, 260)
  const least = floorOf(last, required)
  const x = (runs: number) => LEFT + ((wide - LEFT - RIGHT) * runs) / last.runs
  const y = (rate: number) => TOP + ((HEIGHT - TOP - BOTTOM) * (1 - rate)) / (1 - least)
  const banded = curve.filter((point) => point.interval !== null)
  const upper = banded.map((point) => `${x(point.runs)},${y(point.interval?.[1] ?? 1)}`)
  const lower = banded.map((point) => `${x(point.runs)},${y(point.interval?.[0] ?? 0)}`).toReversed()
  const lines = Array.from({ length: LINES }, (_, at) => least + ((1 - least) * at) / (LINES - 1))
  const end = last.interval ? `, interval ${intervalText(last.interval)}` : ''
  return (
    <div ref={ref}>
      <svg
        className={`${classes.drawing} ${classes.plot}`}
        viewBox={`0 0 ${wide} ${HEIGHT}`}
        height={HEIGHT}
        role="img"
        aria-label={`Success rate after each of ${last.runs} runs; at the end ${percent(last.rate)}${end}`}
      >
        <clipPath id={clip}>
          <rect x={LEFT} y={TOP} width={wide - LEFT - RIGHT} height={HEIGHT - TOP - BOTTOM} />
        </clipPath>
        {lines.map((rate) => (
          <g key={rate}>
            <line className="grid" x1={LEFT} x2={wide - RIGHT} y1={y(rate)} y2={y(rate)} />
            <text x={LEFT - 7} y={y(rate) + 4} textAnchor="end">
              {Number((100 * rate).toFixed(1))} %
            </text>
          </g>
        ))}
        <g clipPath={`url(#${clip})`}>
          <polygon className={classes.band} points={[...upper, ...lower].join(' ')} />
          <polyline className="rate" points={curve.map((point) => `${x(point.runs)},${y(point.rate)}`).join(' ')} />
          {required !== undefined && <line className={classes.required} x1={LEFT} x2={wide - RIGHT} y1={y(required)} y2={y(required)} />}
        </g>
        <text x={LEFT} y={HEIGHT - 9}>
          0
        </text>
        <text x={wide - RIGHT} y={HEIGHT - 9} textAnchor="end">
          {last.runs} runs
        </text>
      </svg>
      <Group gap="2xs" mt="4xs" fz="0.78rem" c="dimmed">
        <Key>
          <line className="rate" x2={18} y1={5} y2={5} />
        </Key>{' '}
        rate
        {last.interval && (
          <>
            <Key>
              <rect className={classes.band} width={18} height={10} />
            </Key>{' '}
            interval
          </>
        )}
        {required !== undefined && (
          <>
            <Key>
              <line className={classes.required} x2={18} y1={5} y2={5} />
            </Key>{' '}
            required {percent(required)}
          </>
        )}
      </Group>
    </div>
  )
}

function Key({ children }: { readonly children: ReactNode }) {
  return (
    <svg className={classes.drawing} width={18} height={10} aria-hidden>
      {children}
    </svg>
  )
}

/** The rate at the lower edge: as much as the last interval and what is required need, in steps of a tenth. */
function floorOf(last: CurvePoint, required = 1): number {
  const needed = Math.min(last.interval?.[0] ?? last.rate, required)
  return Math.min(0.9, Math.max(0, Math.floor(10 * (needed - 0.1)) / 10))
}

/** Curves over time as one small drawing. */
import { Box, Flex, Text } from '@mantine/core'
import { useId } from 'react'
import type { Curve } from '../../document/teaching'
import classes from './Chart.module.css'

const WIDTH = 560
const HEIGHT = 190
const LEFT = 64
const BOTTOM = 24
const TOP = 10
const RIGHT = 10
const TICKS = 4
const COLOURS = ['var(--active)', 'var(--failed)', 'var(--done)', 'var(--stopped)', 'var(--quiet)'] as const

/** A curve and which of the page's colours it has; `isDashed` for what was learned. */
export interface Drawn extends Curve {
  readonly colour: number
  readonly isDashed: boolean
}

export function Chart({ curves, unit, label }: { readonly curves: readonly Drawn[]; readonly unit: string; readonly label: string }) {
  const id = useId()
  const times = curves.flatMap((curve) => [curve.times_s[0] ?? 0, curve.times_s.at(-1) ?? 0])
  const values = curves.flatMap((curve) => [...curve.values])
  const [from, to] = range(times, 0.1)
  const [low, high] = range(values, 1)
  const x = (time: number) => LEFT + ((time - from) / (to - from)) * (WIDTH - LEFT - RIGHT)
  const y = (value: number) => HEIGHT - BOTTOM - ((value - low) / (high - low)) * (HEIGHT - BOTTOM - TOP)
  const ticks = Array.from({ length: TICKS + 1 }, (_, at) => at / TICKS)
  return (
    <Box component="figure" m={0}>
      <svg className={classes.chart} viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-labelledby={id}>
        <title id={id}>{label}</title>
        {ticks.map((share) => (
          <g key={share}>
            <line x1={LEFT} x2={WIDTH - RIGHT} y1={y(low + share * (high - low))} y2={y(low + share * (high - low))} />
            <text x={LEFT - 6} y={y(low + share * (high - low)) + 4} textAnchor="end">
              {`${short(low + share * (high - low), high - low)}${share === 1 ? ` ${unit}` : ''}`}
            </text>
            <text x={x(from + share * (to - from))} y={HEIGHT - 6} textAnchor={share === 1 ? 'end' : 'middle'}>
              {`${short(from + share * (to - from), to - from)}${share === 1 ? ' s' : ''}`}
            </text>
          </g>
        ))}
        {curves.map((curve) => (
          <path
            key={curve.name}
            color={COLOURS[curve.colour]}
            data-dashed={curve.isDashed || undefined}
            d={curve.times_s
              .map((time, at) => `${at === 0 ? 'M' : 'L'}${x(time).toFixed(1)} ${y(curve.values[at] ?? 0).toFixed(1)}`)
              .join('')}
          />
        ))}
      </svg>
      <Flex component="figcaption" wrap="wrap" gap="xs">
        {curves.map((curve) => (
          <CurveKey key={curve.name} name={curve.name} colour={curve.colour} isDashed={curve.isDashed} />
        ))}
      </Flex>
    </Box>
  )
}

interface CurveKeyProps {
  readonly name: string
  readonly colour: number
  readonly isDashed?: boolean
}

/** A name in the colour of its curve. */
export function CurveKey({ name, colour, isDashed = false }: CurveKeyProps) {
  return (
    <Text span size="xs" c={COLOURS[colour] ?? 'dimmed'} className={classes.key} data-dashed={isDashed || undefined}>
      {name}
    </Text>
  )
}

function range(values: readonly number[], least: number): readonly [number, number] {
  const low = Math.min(...values)
  const high = Math.max(...values)
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, least]
  const middle = (low + high) / 2
  const half = Math.max((high - low) / 2, least / 2)
  return [middle - half, middle + half]
}

function short(value: number, span: number): string {
  return value.toFixed(span < 0.5 ? 2 : span < 20 ? 1 : 0).replace(/^-(0(?:\.0*)?)$/, '$1')
}

/** Runs over two factors, by shape and colour of how they ended; a click or the keyboard chooses one. */
import { Group, NativeSelect, Text } from '@mantine/core'
import { useElementSize } from '@mantine/hooks'
import { useId, useMemo, useState, type KeyboardEvent } from 'react'
import type { TrialResult } from '../../api/types'
import { axisScale, cellOf, labelOf, scatterAxes, short } from '../../document/sweeps'
import classes from './drawings.module.css'

const HEIGHT = 300
const LEFT = 70
const RIGHT = 18
const TOP = 14
const BOTTOM = 30

export interface RunScatterProps {
  readonly runs: readonly TrialResult[]
  /** Those that matter most first. */
  readonly factors: readonly string[]
  readonly selected: number | undefined
  readonly onSelect: (run: number) => void
}

export function RunScatter({ runs, factors, selected, onSelect }: RunScatterProps) {
  const axes = useMemo(() => scatterAxes(runs, factors), [runs, factors])
  const [chosen, setChosen] = useState<{ readonly x: string; readonly y: string }>()
  const x = chosen && axes.includes(chosen.x) ? chosen.x : (axes[0] ?? 'duration')
  const y = chosen && axes.includes(chosen.y) ? chosen.y : (axes[1] ?? 'duration')
  return (
    <>
      <Group gap="md" mb="3xs">
        <AxisChoice label="Across" axes={axes} value={x} onChoose={(axis) => setChosen({ x: axis, y })} />
        <AxisChoice label="Upwards" axes={axes} value={y} onChoose={(axis) => setChosen({ x, y: axis })} />
      </Group>
      <Points runs={runs} x={x} y={y} selected={selected} onSelect={onSelect} />
      <Group gap="2xs" mt="4xs" fz="0.78rem" c="dimmed">
        <svg className={classes.drawing} width={12} height={12} viewBox="-6 -6 12 12" aria-hidden>
          <circle className="good" r={4} />
        </svg>{' '}
        succeeded
        <svg className={classes.drawing} width={12} height={12} viewBox="-6 -6 12 12" aria-hidden>
          <path className="bad" d={CROSS} />
        </svg>{' '}
        did not
        <span>Arrow keys go from run to run, Enter chooses.</span>
      </Group>
    </>
  )
}

const CROSS = 'M-4 -4L4 4M4 -4L-4 4'

function AxisChoice({
  label,
  axes,
  value,
  onChoose,
}: {
  readonly label: string
  readonly axes: readonly string[]
  readonly value: string
  readonly onChoose: (axis: string) => void
}) {
  const id = useId()
  return (
    <Group gap="3xs" wrap="nowrap">
      <Text component="label" htmlFor={id} fz="0.8rem">
        {label}
      </Text>
      <NativeSelect id={id} size="xs" maw="13rem" value={value} onChange={(event) => onChoose(event.currentTarget.value)}>
        {axes.map((axis) => (
          <option key={axis}>{axis}</option>
        ))}
      </NativeSelect>
    </Group>
  )
}

interface PointsProps extends Omit<RunScatterProps, 'factors'> {
  readonly x: string
  readonly y: string
}

function Points({ runs, x, y, selected, onSelect }: PointsProps) {
  const { ref, width } = useElementSize()
  const base = useId()
  const [active, setActive] = useState<number>()
  const wide = Math.max(width, 260)
  const [across, upwards] = useMemo(() => [axisScale(runs, x), axisScale(runs, y)], [runs, x, y])
  const px = (share: number) => LEFT + (wide - LEFT - RIGHT) * share
  const py = (share: number) => HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * share
  const byPlace = useMemo(() => runs.toSorted((left, right) => across.of(left) - across.of(right)), [runs, across])
  // Failing ones last, so that no success hides one.
  const drawn = useMemo(() => runs.toSorted((left, right) => Number(right.success) - Number(left.success)), [runs])

  function onKeyDown(event: KeyboardEvent): void {
    const at = byPlace.findIndex((run) => run.configuration.number === (active ?? selected))
    const next = { ArrowRight: at + 1, ArrowUp: at + 1, ArrowLeft: at - 1, ArrowDown: at - 1, Home: 0, End: byPlace.length - 1 }[event.key]
    if (next !== undefined) {
      event.preventDefault()
      setActive(byPlace[Math.min(Math.max(next, 0), byPlace.length - 1)]?.configuration.number)
    } else if ((event.key === 'Enter' || event.key === ' ') && active !== undefined) {
      event.preventDefault()
      onSelect(active)
    }
  }

  return (
    <div ref={ref}>
      <svg
        className={`${classes.drawing} ${classes.plot}`}
        viewBox={`0 0 ${wide} ${HEIGHT}`}
        height={HEIGHT}
        role="listbox"
        tabIndex={0}
        aria-label={`Runs by ${x} and ${y}`}
        aria-activedescendant={active === undefined ? undefined : `${base}${active}`}
        onKeyDown={onKeyDown}
        onBlur={() => setActive(undefined)}
      >
        <g aria-hidden>
          <rect className="frame" x={LEFT} y={TOP} width={wide - LEFT - RIGHT} height={HEIGHT - TOP - BOTTOM} />
          {across.marks.map(({ at, label }, index) => (
            <text key={label} x={px(at)} y={HEIGHT - 10} textAnchor={anchor(index, across.marks.length)}>
              {label}
            </text>
          ))}
          {upwards.marks.map(({ at, label }) => (
            <text key={label} x={LEFT - 7} y={py(at) + 4} textAnchor="end">
              {label.length > 8 ? `${label.slice(0, 7)}…` : label}
            </text>
          ))}
        </g>
        {drawn.map((run) => {
          const { number } = run.configuration
          return (
            <g
              key={number}
              id={`${base}${number}`}
              role="option"
              aria-selected={number === selected}
              aria-label={`Run ${number}: ${labelOf(run)}, ${x} ${short(cellOf(run, x))}, ${y} ${short(cellOf(run, y))}`}
              className={classes.point}
              data-active={number === active || undefined}
              transform={`translate(${px(across.of(run))} ${py(upwards.of(run))})`}
              onClick={() => onSelect(number)}
            >
              <title>{`#${number} ${labelOf(run)}`}</title>
              <circle r={9} />
              {run.success ? <circle className="good" r={4} /> : <path className="bad" d={CROSS} />}
            </g>
          )
        })}
      </svg>
    </div>
  )
}

function anchor(index: number, count: number): 'start' | 'middle' | 'end' {
  if (index === 0 && count === 3) return 'start'
  return index === 2 && count === 3 ? 'end' : 'middle'
}

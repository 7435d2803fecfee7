/** The curves with their colours, their values now or where one points, and how to take one away. */
import { CloseButton, List } from '@mantine/core'
import type { Curves } from '../../document/curves'
import { numeral } from '../../document/values'
import classes from './plots.module.css'

export interface LegendEntry {
  readonly id: string
  readonly topic: string
  readonly label: string
  readonly unit: string
  readonly color: number
}

interface LegendProps {
  readonly entries: readonly LegendEntry[]
  readonly curves: Curves
  readonly atS: number | undefined
  readonly endS: number | undefined
  readonly onRemove?: (id: string) => void
}

export function Legend({ entries, curves, atS, endS, onRemove }: LegendProps) {
  const last = endS === undefined ? curves.length - 1 : curves.nearest(endS)
  const row = atS === undefined ? last : curves.nearest(atS)
  return (
    <List listStyleType="none" className={classes.legend ?? ''} aria-label="Curves">
      {entries.map((entry) => {
        const value = row === undefined || row < 0 ? NaN : curves.value(entry.id, row)
        return (
          <li key={entry.id}>
            <span
              className={classes.color}
              data-dashed={entry.color >= 8 || undefined}
              style={{ borderColor: `var(--curve-${entry.color % 8})` }}
              aria-hidden
            />
            <span className={classes.label} title={`${entry.topic} ${entry.label}`}>
              {entry.label} <span>{entry.topic}</span>
            </span>
            <span>
              {valueText(value)} {entry.unit}
            </span>
            {onRemove && (
              <CloseButton
                size="xs"
                iconSize={12}
                aria-label={`Take away ${entry.label} of ${entry.topic}`}
                onClick={() => onRemove(entry.id)}
              />
            )}
          </li>
        )
      })}
    </List>
  )
}

/** Four digits; what is as good as nothing is 0. */
function valueText(value: number): string {
  if (Number.isNaN(value)) return '–'
  return Math.abs(value) < 1e-9 ? '0' : numeral(Number(value.toPrecision(4)))
}

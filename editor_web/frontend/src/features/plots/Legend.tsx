/** The curves with their colours, their values now or where one points, and how to take one away. */
import { IconX } from '@tabler/icons-react'
import type { Curves } from '../../document/curves'
import { numeral } from '../../document/values'

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
    <ul className="plain-list plot-legend" aria-label="Curves">
      {entries.map((entry) => {
        const value = row === undefined || row < 0 ? NaN : curves.value(entry.id, row)
        return (
          <li key={entry.id}>
            <span
              className={`plot-color${entry.color >= 8 ? ' is-dashed' : ''}`}
              style={{ borderColor: `var(--curve-${entry.color % 8})` }}
              aria-hidden
            />
            <span className="plot-label" title={`${entry.topic} ${entry.label}`}>
              {entry.label} <span className="quiet">{entry.topic}</span>
            </span>
            <span className="plot-value">
              {valueText(value)} {entry.unit}
            </span>
            {onRemove && (
              <button
                type="button"
                className="plot-remove"
                aria-label={`Take away ${entry.label} of ${entry.topic}`}
                onClick={() => onRemove(entry.id)}
              >
                <IconX size={12} aria-hidden />
              </button>
            )}
          </li>
        )
      })}
    </ul>
  )
}

/** Four digits; what is as good as nothing is 0. */
function valueText(value: number): string {
  if (Number.isNaN(value)) return '–'
  return Math.abs(value) < 1e-9 ? '0' : numeral(Number(value.toPrecision(4)))
}

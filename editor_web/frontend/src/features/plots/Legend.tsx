/** The curves with their colours, their values now or where one points, and how to take one away. */
import { Box, CloseButton, Group, List, Text } from '@mantine/core'
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
  readonly onRemove?: ((id: string) => void) | undefined
}

export function Legend({ entries, curves, atS, endS, onRemove }: LegendProps) {
  const last = endS === undefined ? curves.length - 1 : curves.nearest(endS)
  const row = atS === undefined ? last : curves.nearest(atS)
  return (
    <List listStyleType="none" className={classes.legend ?? ''} px="sm" pb="3xs" fz="0.76rem" aria-label="Curves">
      {entries.map((entry) => {
        const value = row === undefined || row < 0 ? NaN : curves.value(entry.id, row)
        return (
          <li key={entry.id}>
            <Group gap="3xs" wrap="nowrap" miw={0}>
              <Stroke color={entry.color} />
              <Text span inherit truncate flex={1} title={`${entry.topic} ${entry.label}`}>
                {entry.label}{' '}
                <Text span inherit c="dimmed" className={classes.topic ?? ''}>
                  {entry.topic}
                </Text>
              </Text>
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
            </Group>
          </li>
        )
      })}
    </List>
  )
}

/** How a curve looks. */
export function Stroke({ color }: { readonly color: number }) {
  const style = { borderTop: `3px ${color >= 8 ? 'dashed' : 'solid'} var(--curve-${color % 8})` }
  return <Box component="span" flex="none" w={16} style={style} aria-hidden />
}

/** Four digits; what is as good as nothing is 0. */
export function valueText(value: number): string {
  if (Number.isNaN(value)) return '–'
  return Math.abs(value) < 1e-9 ? '0' : numeral(Number(value.toPrecision(4)))
}

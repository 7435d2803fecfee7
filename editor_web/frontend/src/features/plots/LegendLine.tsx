/** The curves with their values at the cursor, in one line where there is no room for more. */
import { Group, Text } from '@mantine/core'
import type { Curves } from '../../document/curves'
import { Stroke, valueText, type LegendEntry } from './Legend'

interface LegendLineProps {
  readonly entries: readonly LegendEntry[]
  readonly curves: Curves
  readonly atS: number
}

export function LegendLine({ entries, curves, atS }: LegendLineProps) {
  const row = curves.nearest(atS) ?? -1
  return (
    <Group
      component="ul"
      aria-label="Curves"
      tabIndex={0}
      flex={1}
      miw={0}
      m={0}
      p={0}
      gap="sm"
      wrap="nowrap"
      style={{ listStyle: 'none', overflowX: 'auto', scrollbarWidth: 'none', fontVariantNumeric: 'tabular-nums' }}
    >
      {entries.map(({ id, topic, label, unit, color }) => (
        <Group component="li" key={id} gap="3xs" wrap="nowrap" flex="none" title={`${topic} ${label}`}>
          <Stroke color={color} />
          <Text span fz="0.76rem">
            {label} {valueText(curves.value(id, row))} {unit}
          </Text>
        </Group>
      ))}
    </Group>
  )
}

/** Which factor matters: success by level with intervals, and rank correlations; those that matter most first. */
import { Table } from '@mantine/core'
import type { FactorEffect } from '../../api/types'
import { percent } from '../../document/sweeps'
import { IntervalBar } from './IntervalBar'
import { Note, PartTitle } from './Note'
import { ResultTable, UnseenHead } from './ResultTable'

const FIRST = 8

export function FactorEffects({ effects }: { readonly effects: readonly FactorEffect[] }) {
  return effects.slice(0, FIRST).map((effect) => (
    <div key={effect.address}>
      <PartTitle isMono>{effect.address}</PartTitle>
      <Note isQuiet>{effectText(effect)}</Note>
      <ResultTable label={`Success by ${effect.address}`}>
        <UnseenHead>
          <Table.Tr>
            <Table.Th scope="col">Value</Table.Th>
            <Table.Th scope="col">Succeeded</Table.Th>
            <Table.Th scope="col">Rate</Table.Th>
            <Table.Td />
          </Table.Tr>
        </UnseenHead>
        <Table.Tbody>
          {effect.levels.map((level) => (
            <Table.Tr key={level.label}>
              <Table.Th scope="row">{level.label}</Table.Th>
              <Table.Td ta="right">
                {level.successes} of {level.runs}
              </Table.Td>
              <Table.Td ta="right">{percent(level.successes / level.runs)}</Table.Td>
              <Table.Td w="34%" miw={90}>
                <IntervalBar interval={level.interval} rate={level.successes / level.runs} />
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </ResultTable>
    </div>
  ))
}

function effectText(effect: FactorEffect): string {
  const parts = [
    ['success', effect.with_success],
    ['duration', effect.with_duration],
  ].flatMap(([name, value]) => (typeof value === 'number' ? [`correlation with ${name} ${signed(value)}`] : []))
  return parts.join('; ')
}

function signed(value: number): string {
  return `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)}`
}

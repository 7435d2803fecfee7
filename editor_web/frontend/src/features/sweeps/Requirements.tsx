/** What a sweep requires of numbers of its runs, with the interval by which each requirement is judged. */
import { Group, Table, VisuallyHidden } from '@mantine/core'
import type { JudgedRequirement } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { intervalText, keptText, verdictWords } from '../../document/sweeps'
import { IntervalBar } from './IntervalBar'
import { ResultTable } from './ResultTable'

export function Requirements({ requirements }: { readonly requirements: readonly JudgedRequirement[] }) {
  // A success rate alone is told by the badge and the curve.
  if (requirements.every(({ number }) => number === null)) return null
  return (
    <ResultTable label="What is required">
      <Table.Thead>
        <Table.Tr>
          <Table.Th scope="col">Required</Table.Th>
          <Table.Th scope="col">Runs that keep it</Table.Th>
          <Table.Th scope="col">Interval</Table.Th>
          <Table.Td />
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {requirements.map((each) => (
          <Table.Tr key={each.text}>
            <Table.Th scope="row">
              <Group gap="3xs" wrap="nowrap">
                <Verdict verdict={each.verdict} />
                {each.text}
              </Group>
            </Table.Th>
            <Table.Td>{keptText(each)}</Table.Td>
            <Table.Td>{each.interval !== null && intervalText(each.interval)}</Table.Td>
            <Table.Td w="34%" miw={90}>
              {each.interval !== null && each.runs > 0 && (
                <IntervalBar interval={each.interval} rate={each.kept / each.runs} isBad={each.verdict === 'failed'} />
              )}
            </Table.Td>
          </Table.Tr>
        ))}
      </Table.Tbody>
    </ResultTable>
  )
}

function Verdict({ verdict }: { readonly verdict: JudgedRequirement['verdict'] }) {
  const words = verdictWords(verdict)
  if (!words) return null
  return (
    <>
      <StatusIcon status={words[0]} size={14} />
      <VisuallyHidden>{words[1].toLowerCase()}: </VisuallyHidden>
    </>
  )
}

/** How long a behavior and its nodes took: median, quartiles, extremes, and the latest run beside them. */
import { Box, Table } from '@mantine/core'
import type { DurationSpread, NodeTrend } from '../../api/types'
import { duration } from '../../document/time'

interface DurationTableProps {
  readonly whole: DurationSpread
  readonly nodes: readonly NodeTrend[]
}

export function DurationTable({ whole, nodes }: DurationTableProps) {
  return (
    <Box h="100%" style={{ overflow: 'auto' }}>
      <Table fz="0.82rem" verticalSpacing="4xs" horizontalSpacing="2xs" borderColor="var(--line)" tabularNums stickyHeader>
        <Table.Thead>
          <Table.Tr>
            <Table.Th scope="col" bg="var(--surface)" c="dimmed">
              Node
            </Table.Th>
            {['Runs', 'Median', 'Quartiles', 'Least', 'Most', 'Latest'].map((name) => (
              <Table.Th key={name} scope="col" ta="right" bg="var(--surface)" c="dimmed">
                {name}
              </Table.Th>
            ))}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          <Row name="Whole run" spread={whole} />
          {nodes.map((node) => (
            <Row key={node.path} name={node.path} spread={node} />
          ))}
        </Table.Tbody>
      </Table>
    </Box>
  )
}

function Row({ name, spread }: { readonly name: string; readonly spread: DurationSpread }) {
  const { count, median_s, lower_s, upper_s, least_s, most_s, last_s } = spread
  const isOutside = last_s !== null && (last_s < least_s || last_s > most_s)
  return (
    <Table.Tr>
      <Table.Th scope="row" fw={400} style={{ overflowWrap: 'anywhere' }}>
        {name}
      </Table.Th>
      <Table.Td ta="right">{count}</Table.Td>
      <Table.Td ta="right">{duration(median_s)}</Table.Td>
      <Table.Td ta="right">
        {duration(lower_s)} to {duration(upper_s)}
      </Table.Td>
      <Table.Td ta="right">{duration(least_s)}</Table.Td>
      <Table.Td ta="right">{duration(most_s)}</Table.Td>
      <Table.Td
        ta="right"
        {...(isOutside ? { c: 'var(--stopped)', fw: 620 } : {})}
        title={isOutside ? 'Outside of what the runs that succeeded took' : undefined}
      >
        {last_s === null ? '–' : duration(last_s)}
      </Table.Td>
    </Table.Tr>
  )
}

/** How often each node was visited in two runs, and how long all its visits took. */
import { Box, Checkbox, Table } from '@mantine/core'
import { useState } from 'react'
import type { NodeDifference } from '../../api/types'
import { signed } from '../../document/comparison'
import { duration } from '../../document/time'
import styles from '../../components/table.module.css'

export function NodeDurations({ nodes }: { readonly nodes: readonly NodeDifference[] }) {
  const [isByDifference, setByDifference] = useState(true)
  const change = (each: NodeDifference) => each.duration_right_s - each.duration_left_s
  const rows = isByDifference ? nodes.toSorted((one, other) => Math.abs(change(other)) - Math.abs(change(one))) : nodes
  return (
    <>
      <Box px="md" py="sm">
        <Checkbox
          size="xs"
          label="Largest difference first"
          checked={isByDifference}
          onChange={(event) => setByDifference(event.currentTarget.checked)}
        />
      </Box>
      <Table
        className={styles.table ?? ''}
        verticalSpacing="4xs"
        horizontalSpacing="2xs"
        borderColor="var(--line)"
        tabularNums
        stickyHeader
      >
        <Table.Thead>
          <Table.Tr>
            <Table.Th scope="col">Node</Table.Th>
            <Table.Th scope="col" ta="right">
              Visits
            </Table.Th>
            <Table.Th scope="col" ta="right">
              Left
            </Table.Th>
            <Table.Th scope="col" ta="right">
              Right
            </Table.Th>
            <Table.Th scope="col" ta="right">
              Difference
            </Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {rows.map((each) => (
            <Table.Tr key={each.path}>
              <Table.Th scope="row">{each.path}</Table.Th>
              <Table.Td ta="right">
                {each.visits_left === each.visits_right ? each.visits_left : `${each.visits_left} → ${each.visits_right}`}
              </Table.Td>
              <Table.Td ta="right">{each.visits_left > 0 ? duration(each.duration_left_s) : ''}</Table.Td>
              <Table.Td ta="right">{each.visits_right > 0 ? duration(each.duration_right_s) : ''}</Table.Td>
              <Table.Td ta="right">{signed(change(each))}</Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </>
  )
}

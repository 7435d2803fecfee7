/** Who commands which resource, from which node and with which goal, and since when. */
import { Box, Table, Text } from '@mantine/core'
import { IconLockOpen } from '@tabler/icons-react'
import { Empty } from '../../components/Empty'
import { duration } from '../../document/time'
import { holderText } from './words'
import type { GoalInfo, LeaseMetrics } from '../../api/types'

interface LeasesProps {
  readonly leases: readonly LeaseMetrics[]
  readonly goals: readonly GoalInfo[]
  readonly search: string
}

export function Leases({ leases, goals, search }: LeasesProps) {
  const shown = leases.filter((each) => `${each.resource} ${each.run} ${each.node}`.toLowerCase().includes(search.toLowerCase()))
  if (shown.length === 0) {
    return (
      <Empty icon={<IconLockOpen size={26} stroke={1.4} aria-hidden />} title={leases.length > 0 ? 'Nothing matches' : 'No leases'}>
        {leases.length > 0 ? 'Clear the search.' : 'A run takes an arm or gripper when it first commands it, and keeps it to its end.'}
      </Empty>
    )
  }
  return (
    <Box h="100%" style={{ overflow: 'auto' }} tabIndex={0} role="region" aria-label="Resource leases">
      <Table
        styles={{ th: { background: 'var(--surface)', color: 'var(--quiet)' } }}
        fz="0.8rem"
        verticalSpacing="4xs"
        horizontalSpacing="sm"
        borderColor="var(--line)"
        stickyHeader
        tabularNums
      >
        <Table.Thead>
          <Table.Tr>
            <Table.Th scope="col">Resource</Table.Th>
            <Table.Th scope="col">Held by</Table.Th>
            <Table.Th scope="col">Node</Table.Th>
            <Table.Th scope="col">Goal</Table.Th>
            <Table.Th scope="col">For</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {shown.map((lease) => (
            <Table.Tr key={lease.resource}>
              <Table.Td ff="monospace">{lease.resource}</Table.Td>
              <Table.Td>{holderText(lease.run)}</Table.Td>
              <Table.Td ff="monospace">
                {lease.node || (
                  <Text span inherit c="dimmed">
                    kept by the run
                  </Text>
                )}
              </Table.Td>
              <Table.Td ff="monospace">{goalText(lease, goals)}</Table.Td>
              <Table.Td style={{ whiteSpace: 'nowrap' }}>{duration(lease.held_s)}</Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </Box>
  )
}

function goalText(lease: LeaseMetrics, goals: readonly GoalInfo[]): string {
  const goal = goals.find((each) => each.id === lease.goal)
  return goal ? `${goal.address} (${goal.status})` : '–'
}

/** Failures by cause, and for each cause the ranges of the factors with which runs failed so. */
import { Box, List, Table } from '@mantine/core'
import type { FailureCluster, FactorRegion } from '../../api/types'
import { percent } from '../../document/sweeps'
import { rangeText } from '../../document/searches'
import { CauseButton } from './Outcomes'
import { ResultTable } from './ResultTable'
import table from '../../components/table.module.css'

const HEAD = ['Failing', 'Executed', 'Likelihood', 'Successes in there']

export interface FailureClustersProps {
  readonly clusters: readonly FailureCluster[]
  /** An example of the cause whose runs are listed. */
  readonly chosen: number | undefined
  readonly onChoose: (example: number | undefined) => void
}

export function FailureClusters({ clusters, chosen, onChoose }: FailureClustersProps) {
  return (
    <List listStyleType="none" aria-label="Causes of failures">
      {clusters.map(({ cause, regions }) => (
        <Box component="li" key={`${cause.at} ${cause.message}`} mb="sm">
          <CauseButton cause={cause} chosen={chosen} onChoose={onChoose} />
          {regions.length > 0 && <Regions regions={regions} cause={cause.message} />}
        </Box>
      ))}
    </List>
  )
}

function Regions({ regions, cause }: { readonly regions: readonly FactorRegion[]; readonly cause: string }) {
  return (
    <ResultTable label={`Where it fails: ${cause}`}>
      <Table.Thead>
        <Table.Tr>
          <Table.Th scope="col">Factor</Table.Th>
          {HEAD.map((name) => (
            <Table.Th key={name} scope="col" ta="right">
              {name}
            </Table.Th>
          ))}
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {regions.map((region) => (
          <Table.Tr key={region.address}>
            <Table.Th scope="row" ff="monospace" className={`cut-text ${table.path}`} title={region.address}>
              <bdi>{region.address}</bdi>
            </Table.Th>
            <Table.Td ta="right">{rangeText(region.failing, region.listed)}</Table.Td>
            <Table.Td ta="right">{rangeText(region.executed, region.listed)}</Table.Td>
            <Table.Td ta="right">{percent(region.share)}</Table.Td>
            <Table.Td ta="right">{region.passed_inside}</Table.Td>
          </Table.Tr>
        ))}
      </Table.Tbody>
    </ResultTable>
  )
}

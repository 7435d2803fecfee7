/** The runs that succeeded and came nearest to failure, with the number that is searched for. */
import { Anchor, Table } from '@mantine/core'
import type { SearchView } from '../../api/types'
import { lookup } from '../../document/dict'
import { numberOf, short } from '../../document/sweeps'
import { ResultTable } from './ResultTable'

export function NearestRuns({ view, onSelect }: { readonly view: SearchView; readonly onSelect: (run: number) => void }) {
  const factors = Object.keys(view.nearest[0]?.configuration.values ?? {}).filter((address) => address !== 'seed')
  return (
    <ResultTable label="Table of the nearest successes">
      <Table.Thead>
        <Table.Tr>
          <Table.Th scope="col">Run</Table.Th>
          {[view.towards, ...factors].map((name) => (
            <Table.Th key={name} scope="col" ta="right">
              {name}
            </Table.Th>
          ))}
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {view.nearest.map((run) => (
          <Table.Tr key={run.configuration.number}>
            <Table.Th scope="row">
              <Anchor c="var(--accent)" component="button" inherit type="button" onClick={() => onSelect(run.configuration.number)}>
                #{run.configuration.number}
              </Anchor>
            </Table.Th>
            <Table.Td ta="right">{short(numberOf(run, view.target.name))}</Table.Td>
            {factors.map((address) => (
              <Table.Td key={address} ta="right">
                {short(lookup(run.configuration.values, address))}
              </Table.Td>
            ))}
          </Table.Tr>
        ))}
      </Table.Tbody>
    </ResultTable>
  )
}

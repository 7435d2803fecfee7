/** The distributions of numbers over runs: quantiles, and the same as a strip. */
import { Anchor, Table } from '@mantine/core'
import { useState } from 'react'
import type { Quantiles, SweepView } from '../../api/types'
import { quantileGroups, short, type QuantileGroup } from '../../document/sweeps'
import { PartTitle } from './Note'
import { ResultTable } from './ResultTable'
import table from '../../components/table.module.css'
import classes from './bars.module.css'

const FIRST = 8

export function Distributions({ view }: { readonly view: SweepView }) {
  return quantileGroups(view).map((group) => <Quantities key={group.key} group={group} />)
}

function Quantities({ group }: { readonly group: QuantileGroup }) {
  const [isWhole, setWhole] = useState(false)
  const rows = isWhole ? group.rows : group.rows.slice(0, FIRST)
  const rest = group.rows.length - rows.length
  // Seconds of nodes are compared with one another; other numbers have units of their own.
  const common = group.key === 'nodes' ? Math.max(...group.rows.map((row) => row.most)) : undefined
  return (
    <>
      <PartTitle>{group.title}</PartTitle>
      <ResultTable label={`Table: ${group.title}`}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th scope="col">Of</Table.Th>
            {['Least', 'Middle', '95 %', 'Most'].map((name) => (
              <Table.Th key={name} scope="col" ta="right">
                {name}
              </Table.Th>
            ))}
            <Table.Td />
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {rows.map((row) => (
            <Table.Tr key={row.name}>
              <Table.Th scope="row" ff="monospace" className={`cut-text ${table.path}`} title={`${row.name}, ${row.runs} runs`}>
                {row.name}
              </Table.Th>
              {[row.least, row.middle, row.p95, row.most].map((value, at) => (
                <Table.Td key={at} ta="right">
                  {short(value)}
                </Table.Td>
              ))}
              <Table.Td w="34%" miw={90}>
                <Strip row={row} from={common === undefined ? row.least : 0} to={common ?? row.most} />
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </ResultTable>
      {rest > 0 && (
        <Anchor c="var(--accent)" component="button" inherit type="button" onClick={() => setWhole(true)}>
          Show {rest} more
        </Anchor>
      )}
    </>
  )
}

function Strip({ row, from, to }: { readonly row: Quantiles; readonly from: number; readonly to: number }) {
  const at = (value: number) => `${(100 * (value - from)) / (to - from || 1)}%`
  const width = (low: number, high: number) => `${(100 * (high - low)) / (to - from || 1)}%`
  return (
    <span className={classes.bar} aria-hidden>
      <span style={{ left: at(row.least), width: width(row.least, row.most) }} />
      <span className={classes.box} style={{ left: at(row.middle), width: width(row.middle, row.p95) }} />
      <span className={classes.mark} style={{ left: at(row.middle) }} />
    </span>
  )
}

/** Values of two runs beside one another. */
import { Table } from '@mantine/core'
import type { ValueChange } from '../../api/types'
import styles from '../../components/table.module.css'

export function DifferenceTable({ rows, name }: { readonly rows: readonly ValueChange[]; readonly name: string }) {
  return (
    <Table className={styles.table ?? ''} verticalSpacing="4xs" horizontalSpacing="2xs" borderColor="var(--line)" tabularNums stickyHeader>
      <Table.Thead>
        <Table.Tr>
          <Table.Th scope="col">{name}</Table.Th>
          <Table.Th scope="col">Left</Table.Th>
          <Table.Th scope="col">Right</Table.Th>
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {rows.map((each) => (
          <Table.Tr key={each.at}>
            <Table.Th scope="row">{each.at}</Table.Th>
            <Value text={each.left} />
            <Value text={each.right} />
          </Table.Tr>
        ))}
      </Table.Tbody>
    </Table>
  )
}

function Value({ text }: { readonly text: string | null }) {
  return (
    <Table.Td {...(text === null ? { c: 'dimmed' } : { ff: 'monospace' })} style={{ overflowWrap: 'anywhere' }}>
      {text ?? 'nothing'}
    </Table.Td>
  )
}

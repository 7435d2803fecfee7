/** A table of results, which scrolls by itself where it is wider than its card. */
import { Box, Table } from '@mantine/core'
import type { ReactNode } from 'react'
import classes from '../../components/table.module.css'

export interface ResultTableProps {
  readonly label: string
  /** Does a press on a row choose it? */
  readonly isChosenFrom?: boolean
  readonly children: ReactNode
}

export function ResultTable({ label, isChosenFrom = false, children }: ResultTableProps) {
  return (
    <Box maw="100%" style={{ overflowX: 'auto' }} tabIndex={0} role="group" aria-label={label}>
      <Table
        className={classes.table ?? ''}
        style={{ whiteSpace: 'nowrap', cursor: isChosenFrom ? 'pointer' : 'auto' }}
        tabularNums
        verticalSpacing="4xs"
        horizontalSpacing="2xs"
        borderColor="var(--line)"
        highlightOnHover={isChosenFrom}
        highlightOnHoverColor="var(--ground)"
      >
        {children}
      </Table>
    </Box>
  )
}

/** The head of a table whose columns are plain to see; those who hear the page hear it. */
export function UnseenHead({ children }: { readonly children: ReactNode }) {
  return (
    <Table.Thead pos="absolute" w={1} h={1} style={{ overflow: 'hidden', clipPath: 'inset(50%)' }}>
      {children}
    </Table.Thead>
  )
}

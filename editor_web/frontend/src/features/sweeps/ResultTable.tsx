/** A table of results, which scrolls by itself where it is wider than its card. */
import { Table } from '@mantine/core'
import type { ReactNode } from 'react'
import classes from './table.module.css'

export interface ResultTableProps {
  readonly label: string
  /** Does a press on a row choose it? */
  readonly isChosenFrom?: boolean
  readonly children: ReactNode
}

export function ResultTable({ label, isChosenFrom = false, children }: ResultTableProps) {
  return (
    <div className={classes.scroll} tabIndex={0} role="group" aria-label={label}>
      <Table
        className={`${classes.table} ${isChosenFrom ? classes.chosen : ''}`}
        tabularNums
        verticalSpacing="4xs"
        horizontalSpacing="2xs"
        borderColor="var(--line)"
        highlightOnHover={isChosenFrom}
        highlightOnHoverColor="var(--ground)"
      >
        {children}
      </Table>
    </div>
  )
}

/** The visits of two runs, aligned: how each ended, how long it took, and where they differ. */
import { Button, Switch, UnstyledButton } from '@mantine/core'
import { useEffect, useRef, useState } from 'react'
import type { AlignedVisit, Visit } from '../../api/types'
import { Panel } from '../../components/Panel'
import { StatusIcon } from '../../components/StatusIcon'
import { statusOf } from '../../document/runState'
import { differenceS, durationOf, endWords, isDifferent, signed } from '../../document/comparison'
import { duration } from '../../document/time'
import { depthOf, nameOfPath } from '../../document/path'
import styles from './comparison.module.css'

interface VisitTableProps {
  readonly visits: readonly AlignedVisit[]
  readonly leftOut: number
  readonly selected: number | undefined
  readonly onSelect: (index: number) => void
}

const PAGE = 300

export function VisitTable({ visits, leftOut, selected, onSelect }: VisitTableProps) {
  const [isShort, setShort] = useState(false)
  const [most, setMost] = useState(PAGE)
  const rows = visits.flatMap((visit, index) => (!isShort || index === selected || isDifferent(visit) ? [{ visit, index }] : []))
  const reach = Math.max(most, 1 + rows.findIndex((row) => row.index === selected))
  return (
    <Panel
      title="Visits"
      tools={
        <div className={styles.tools}>
          {leftOut > 0 && <span className="quiet">{leftOut} more are alike</span>}
          <Switch size="xs" label="Only differences" checked={isShort} onChange={(event) => setShort(event.currentTarget.checked)} />
        </div>
      }
    >
      <div className={styles.scroll} role="region" tabIndex={0} aria-label="Table of visits">
        <table className={styles.table}>
          <thead>
            <tr>
              <th scope="col">Node</th>
              <th scope="col">Left</th>
              <th scope="col" className={styles.number}>
                took
              </th>
              <th scope="col">Right</th>
              <th scope="col" className={styles.number}>
                took
              </th>
              <th scope="col" className={styles.number}>
                Difference
              </th>
            </tr>
          </thead>
          <tbody>
            {rows.slice(0, reach).map(({ visit, index }) => (
              <Row key={index} visit={visit} isSelected={index === selected} onSelect={() => onSelect(index)} />
            ))}
          </tbody>
        </table>
        {rows.length > reach && (
          <Button variant="default" size="xs" m="sm" onClick={() => setMost(reach + PAGE)}>
            Show more of {rows.length}
          </Button>
        )}
      </div>
    </Panel>
  )
}

function Row({
  visit,
  isSelected,
  onSelect,
}: {
  readonly visit: AlignedVisit
  readonly isSelected: boolean
  readonly onSelect: () => void
}) {
  const row = useRef<HTMLTableRowElement>(null)
  useEffect(() => {
    if (isSelected) row.current?.scrollIntoView({ block: 'nearest' })
  }, [isSelected])
  const { path, left, right } = visit
  const [took, tookRight] = [durationOf(left), durationOf(right)]
  const number = (left ?? right)?.visit ?? 1
  const depth = depthOf(path)
  const name = nameOfPath(path)
  const classes = [isDifferent(visit) && styles.isDifferent, isSelected && styles.isSelected]
  return (
    <tr ref={row} className={classes.filter(Boolean).join(' ') || undefined} aria-selected={isSelected}>
      <th scope="row" style={{ paddingInlineStart: `${0.6 + depth}em` }}>
        <UnstyledButton className={styles.name} aria-pressed={isSelected} aria-label={`${path}, visit ${number}`} onClick={onSelect}>
          {name}
          {number > 1 && <span className="quiet"> {number}</span>}
        </UnstyledButton>
      </th>
      <End visit={left} />
      <td className={styles.number}>{took === undefined ? '' : duration(took)}</td>
      <End visit={right} />
      <td className={styles.number}>{tookRight === undefined ? '' : duration(tookRight)}</td>
      <td className={styles.number}>{signed(differenceS(took, tookRight))}</td>
    </tr>
  )
}

function End({ visit }: { readonly visit: Visit | null }) {
  return (
    <td title={visit?.cause || undefined}>
      <span className={`${styles.end} ${visit ? '' : styles.missing}`}>
        {visit && <StatusIcon status={statusOf(visit.status)} size={13} />}
        {endWords(visit)}
      </span>
    </td>
  )
}

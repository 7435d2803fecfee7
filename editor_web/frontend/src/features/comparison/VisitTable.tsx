/** The visits of two runs, aligned: how each ended, how long it took, and where they differ. */
import { Box, Button, Group, Switch, Table, Text, UnstyledButton } from '@mantine/core'
import { useEffect, useRef, useState } from 'react'
import type { AlignedVisit, Visit } from '../../api/types'
import { KindIcon } from '../../components/KindIcon'
import { Panel } from '../../components/Panel'
import { StatusIcon } from '../../components/StatusIcon'
import { statusOf } from '../../document/runState'
import { differenceS, durationOf, endWords, isDifferent, signed } from '../../document/comparison'
import { lookup, type Dict } from '../../document/dict'
import { duration } from '../../document/time'
import { depthOf, nameOfPath } from '../../document/path'
import styles from '../../components/table.module.css'

interface VisitTableProps {
  readonly visits: readonly AlignedVisit[]
  /** The names of the icons of nodes, by path. */
  readonly icons: Dict<string>
  readonly leftOut: number
  readonly selected: number | undefined
  readonly onSelect: (index: number) => void
}

const PAGE = 300

export function VisitTable({ visits, icons, leftOut, selected, onSelect }: VisitTableProps) {
  const [isShort, setShort] = useState(false)
  const [most, setMost] = useState(PAGE)
  const rows = visits.flatMap((visit, index) => (!isShort || index === selected || isDifferent(visit) ? [{ visit, index }] : []))
  const reach = Math.max(most, 1 + rows.findIndex((row) => row.index === selected))
  return (
    <Panel
      title="Visits"
      tools={
        <Group gap="sm" flex={1} justify="end">
          {leftOut > 0 && (
            <Text span inherit c="dimmed">
              {leftOut} more are alike
            </Text>
          )}
          <Switch size="xs" label="Only differences" checked={isShort} onChange={(event) => setShort(event.currentTarget.checked)} />
        </Group>
      }
    >
      <Box h="100%" style={{ overflow: 'auto' }} role="region" tabIndex={0} aria-label="Table of visits">
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
              <Table.Th scope="col">Left</Table.Th>
              <Table.Th scope="col" ta="right">
                took
              </Table.Th>
              <Table.Th scope="col">Right</Table.Th>
              <Table.Th scope="col" ta="right">
                took
              </Table.Th>
              <Table.Th scope="col" ta="right">
                Difference
              </Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {rows.slice(0, reach).map(({ visit, index }) => (
              <Row
                key={index}
                visit={visit}
                icon={lookup(icons, visit.path)}
                isSelected={index === selected}
                onSelect={() => onSelect(index)}
              />
            ))}
          </Table.Tbody>
        </Table>
        {rows.length > reach && (
          <Button variant="default" size="xs" m="sm" onClick={() => setMost(reach + PAGE)}>
            Show more of {rows.length}
          </Button>
        )}
      </Box>
    </Panel>
  )
}

function Row({
  visit,
  icon,
  isSelected,
  onSelect,
}: {
  readonly visit: AlignedVisit
  readonly icon: string | undefined
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
  return (
    <Table.Tr ref={row} data-different={isDifferent(visit) || undefined} aria-selected={isSelected}>
      <Table.Th scope="row" style={{ paddingInlineStart: `${0.6 + depth}em` }}>
        <UnstyledButton fz="inherit" aria-pressed={isSelected} aria-label={`${path}, visit ${number}`} onClick={onSelect}>
          {icon !== undefined && <KindIcon icon={icon} size={13} />} {name}
          {number > 1 && (
            <Text span inherit c="dimmed">
              {' '}
              {number}
            </Text>
          )}
        </UnstyledButton>
      </Table.Th>
      <End visit={left} />
      <Table.Td ta="right">{took === undefined ? '' : duration(took)}</Table.Td>
      <End visit={right} />
      <Table.Td ta="right">{tookRight === undefined ? '' : duration(tookRight)}</Table.Td>
      <Table.Td ta="right">{signed(differenceS(took, tookRight))}</Table.Td>
    </Table.Tr>
  )
}

function End({ visit }: { readonly visit: Visit | null }) {
  return (
    <Table.Td title={visit?.cause || undefined}>
      <Group gap="4xs" wrap="nowrap" {...(visit ? {} : { c: 'dimmed' })}>
        {visit && <StatusIcon status={statusOf(visit.status)} size={13} />}
        {endWords(visit)}
      </Group>
    </Table.Td>
  )
}

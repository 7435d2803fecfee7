/** The runs of a sweep as a table, failing ones first, in any order that a person asks for. */
import { Anchor, Button, Group, Table, UnstyledButton } from '@mantine/core'
import { IconArrowNarrowDown, IconArrowNarrowUp } from '@tabler/icons-react'
import { useMemo, useState } from 'react'
import type { TrialResult } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { lookup } from '../../document/dict'
import { duration } from '../../document/time'
import { FIRST_ORDER, labelOf, orderedRuns, short, type RunOrder } from '../../document/sweeps'
import { ResultTable } from './ResultTable'

/** Columns that are no numbers. */
const TEXTS = new Set(['number', 'ended', 'cause'])
const FIRST = 15
const PAGE = 50

export interface RunTableProps {
  readonly runs: readonly TrialResult[]
  readonly factors: readonly string[]
  readonly selected: number | undefined
  readonly onSelect: (run: number) => void
}

export function RunTable({ runs, factors, selected, onSelect }: RunTableProps) {
  const [order, setOrder] = useState<RunOrder>(FIRST_ORDER)
  const [most, setMost] = useState(FIRST)
  const ordered = useMemo(() => orderedRuns(runs, order), [runs, order])
  const columns = [
    { by: 'number', name: 'Run' },
    { by: 'ended', name: 'Ended' },
    { by: 'cause', name: 'Cause' },
    { by: 'duration', name: 'Duration' },
    ...factors.map((by) => ({ by, name: by })),
  ]
  return (
    <>
      <ResultTable label="Table of runs" isChosenFrom>
        <Table.Thead>
          <Table.Tr>
            {columns.map(({ by, name }) => (
              <Head key={by} by={by} name={name} order={order} onOrder={setOrder} />
            ))}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {ordered.slice(0, most).map((run) => (
            <Row
              key={run.configuration.number}
              run={run}
              factors={factors}
              isSelected={run.configuration.number === selected}
              onSelect={onSelect}
            />
          ))}
        </Table.Tbody>
      </ResultTable>
      {ordered.length > most && (
        <Button size="compact-sm" variant="default" mt="2xs" onClick={() => setMost(most + PAGE)}>
          Show more of {ordered.length}
        </Button>
      )}
    </>
  )
}

function Head({
  by,
  name,
  order,
  onOrder,
}: {
  readonly by: string
  readonly name: string
  readonly order: RunOrder
  readonly onOrder: (order: RunOrder) => void
}) {
  const isOwn = order.by === by
  const Arrow = order.isFalling ? IconArrowNarrowDown : IconArrowNarrowUp
  return (
    <Table.Th scope="col" ta={TEXTS.has(by) ? 'left' : 'right'} aria-sort={isOwn ? (order.isFalling ? 'descending' : 'ascending') : 'none'}>
      <UnstyledButton
        display="inline-flex"
        fz="inherit"
        style={{ alignItems: 'center' }}
        onClick={() => onOrder({ by, isFalling: isOwn && !order.isFalling })}
      >
        {name}
        {isOwn && <Arrow size={13} aria-hidden />}
      </UnstyledButton>
    </Table.Th>
  )
}

interface RowProps {
  readonly run: TrialResult
  readonly factors: readonly string[]
  readonly isSelected: boolean
  readonly onSelect: (run: number) => void
}

function Row({ run, factors, isSelected, onSelect }: RowProps) {
  const { number, values } = run.configuration
  return (
    <Table.Tr data-selected={isSelected || undefined} onClick={() => onSelect(number)}>
      <Table.Th scope="row">
        <Anchor
          c="var(--accent)"
          component="button"
          inherit
          type="button"
          aria-pressed={isSelected}
          aria-label={`Run ${number}`}
          onClick={() => onSelect(number)}
        >
          #{number}
        </Anchor>
      </Table.Th>
      <Table.Td>
        <Group gap="3xs" wrap="nowrap">
          <StatusIcon status={run.success ? 'done' : 'failed'} size={14} />
          {labelOf(run)}
        </Group>
      </Table.Td>
      <Table.Td className="cut-text" maw="24rem" title={run.cause}>
        {run.reason}
      </Table.Td>
      <Table.Td ta="right">{duration(run.duration_s)}</Table.Td>
      {factors.map((address) => (
        <Table.Td key={address} ta="right">
          {short(lookup(values, address))}
        </Table.Td>
      ))}
    </Table.Tr>
  )
}

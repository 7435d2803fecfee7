/** The runs of a sweep as a table, failing ones first, in any order that a person asks for. */
import { IconArrowNarrowDown, IconArrowNarrowUp } from '@tabler/icons-react'
import { useMemo, useState } from 'react'
import type { TrialResult } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { lookup } from '../../document/dict'
import { duration } from '../../document/time'
import { FIRST_ORDER, labelOf, orderedRuns, short, type RunOrder } from '../../document/sweeps'

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
      <div className="sweep-scroll" tabIndex={0} role="group" aria-label="Table of runs">
        <table className="sweep-table sweep-runs">
          <thead>
            <tr>
              {columns.map(({ by, name }) => (
                <Head key={by} by={by} name={name} order={order} onOrder={setOrder} />
              ))}
            </tr>
          </thead>
          <tbody>
            {ordered.slice(0, most).map((run) => (
              <Row
                key={run.configuration.number}
                run={run}
                factors={factors}
                isSelected={run.configuration.number === selected}
                onSelect={onSelect}
              />
            ))}
          </tbody>
        </table>
      </div>
      {ordered.length > most && (
        <button type="button" className="command sweep-more" onClick={() => setMost(most + PAGE)}>
          Show more of {ordered.length}
        </button>
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
    <th scope="col" aria-sort={isOwn ? (order.isFalling ? 'descending' : 'ascending') : 'none'}>
      <button type="button" className="sweep-sort" onClick={() => onOrder({ by, isFalling: isOwn && !order.isFalling })}>
        {name}
        {isOwn && <Arrow size={13} aria-hidden />}
      </button>
    </th>
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
    <tr className={isSelected ? 'is-selected' : undefined} onClick={() => onSelect(number)}>
      <th scope="row">
        <button type="button" className="link" aria-pressed={isSelected} aria-label={`Run ${number}`} onClick={() => onSelect(number)}>
          #{number}
        </button>
      </th>
      <td>
        <span className="sweep-outcome">
          <StatusIcon status={run.success ? 'done' : 'failed'} size={14} />
          {labelOf(run)}
        </span>
      </td>
      <td className="sweep-reason" title={run.cause}>
        {run.reason}
      </td>
      <td className="is-number">{duration(run.duration_s)}</td>
      {factors.map((address) => (
        <td key={address} className="is-number">
          {short(lookup(values, address))}
        </td>
      ))}
    </tr>
  )
}

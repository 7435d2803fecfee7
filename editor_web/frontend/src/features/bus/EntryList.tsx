/** The entries of one kind, grouped by namespace; topics with their rate and the age of their latest message. */
import { lookup, type Dict } from '../../document/dict'
import { memo, useMemo } from 'react'
import { byNamespace, type Named } from '../../document/busTree'
import { nameOfPath } from '../../document/path'
import { ageText, rateText } from './words'
import type { TopicMetrics } from '../../api/types'

interface EntryListProps {
  readonly entries: readonly Named[]
  readonly kind: string
  readonly chosen: string | undefined
  readonly onChoose: (name: string) => void
  readonly traffic: Dict<TopicMetrics> | undefined
}

export function EntryList({ entries, kind, chosen, onChoose, traffic }: EntryListProps) {
  const groups = useMemo(() => byNamespace(entries), [entries])
  const isTopics = kind === 'topics'
  return (
    <nav className="bus-list" aria-label={`The ${kind} of the bus`}>
      {isTopics && (
        <p className="bus-columns" aria-hidden>
          <span className="grow">Topic</span>
          <span>Rate</span>
          <span>Latest</span>
        </p>
      )}
      {groups.map((group) => (
        <section key={group.name} className="bus-group" aria-label={group.name || 'Without a namespace'}>
          <h3>{group.name || 'without a namespace'}</h3>
          <ul className="plain-list">
            {group.entries.map((entry) => (
              <Row
                key={entry.name}
                name={entry.name}
                type={entry.type}
                isChosen={entry.name === chosen}
                onChoose={onChoose}
                rate={isTopics ? rateText(lookup(traffic, entry.name)) : undefined}
                age={isTopics ? ageText(lookup(traffic, entry.name)) : undefined}
              />
            ))}
          </ul>
        </section>
      ))}
    </nav>
  )
}

interface RowProps {
  readonly name: string
  readonly type: string
  readonly isChosen: boolean
  readonly onChoose: (name: string) => void
  readonly rate: string | undefined
  readonly age: string | undefined
}

/** Drawn again only when its own words change. */
const Row = memo(
  function Row({ name, type, isChosen, onChoose, rate, age }: RowProps) {
    return (
      <li>
        <button type="button" className="bus-row" aria-current={isChosen} onClick={() => onChoose(name)}>
          <span className="bus-name">{nameOfPath(name)}</span>
          <span className="bus-type">{type}</span>
          {rate !== undefined && <span className="bus-figure">{rate}</span>}
          {age !== undefined && <span className="bus-figure">{age}</span>}
        </button>
      </li>
    )
  },
  (before, after) =>
    before.name === after.name &&
    before.type === after.type &&
    before.isChosen === after.isChosen &&
    before.rate === after.rate &&
    before.age === after.age,
)

/** The numbers of all topics as a tree to choose from: topics, their fields, rows at once. */
import { Checkbox, CloseButton, TextInput } from '@mantine/core'
import { IconChevronDown, IconChevronRight, IconSearch } from '@tabler/icons-react'
import { memo, useMemo, useState } from 'react'
import { idOf, rowsOf, shownTopics, type FieldRow } from './fields'
import { MOST_CURVES } from './keptFields'
import type { TopicFields } from '../../api/types'

interface FieldChooserProps {
  readonly topics: readonly TopicFields[]
  readonly chosen: readonly string[]
  readonly onChoose: (fields: readonly string[]) => void
}

/** Not drawn again with every sample. */
export const FieldChooser = memo(function FieldChooser({ topics, chosen, onChoose }: FieldChooserProps) {
  const [search, setSearch] = useState('')
  const [opened, setOpened] = useState<ReadonlySet<string>>(new Set())
  const shown = useMemo(() => shownTopics(topics, search), [topics, search])
  const isFull = chosen.length >= MOST_CURVES

  function toggle(ids: readonly string[], isOn: boolean): void {
    const others = chosen.filter((id) => !ids.includes(id))
    onChoose(isOn ? [...others, ...ids] : others)
  }

  function fold(topic: string): void {
    const next = new Set(opened)
    if (!next.delete(topic)) next.add(topic)
    setOpened(next)
  }

  return (
    <div className="field-chooser">
      <TextInput
        size="xs"
        aria-label="Find a number"
        placeholder="Find a number"
        leftSection={<IconSearch size={14} aria-hidden />}
        rightSection={search && <CloseButton size="xs" aria-label="Clear" onClick={() => setSearch('')} />}
        value={search}
        onChange={(event) => setSearch(event.currentTarget.value)}
      />
      {isFull && <p className="quiet">{MOST_CURVES} curves are the most.</p>}
      {shown.length === 0 && <p className="quiet">Nothing matches.</p>}
      <ul className="plain-list field-topics" aria-label="Numbers of topics">
        {shown.map((each) => {
          const isOpen = search !== '' || opened.has(each.topic)
          const count = each.fields.filter((field) => chosen.includes(idOf(each.topic, field))).length
          const Chevron = isOpen ? IconChevronDown : IconChevronRight
          return (
            <li key={each.topic}>
              <button type="button" className="field-topic" aria-expanded={isOpen} onClick={() => fold(each.topic)}>
                <Chevron size={13} aria-hidden />
                <span>{each.topic}</span>
                {count > 0 && <span className="tab-count">{count}</span>}
              </button>
              {isOpen &&
                rowsOf(each).map((row) => (
                  <Row key={row.name} topic={each.topic} row={row} chosen={chosen} isFull={isFull} onToggle={toggle} />
                ))}
            </li>
          )
        })}
      </ul>
    </div>
  )
})

interface RowProps {
  readonly topic: string
  readonly row: FieldRow
  readonly chosen: readonly string[]
  readonly isFull: boolean
  readonly onToggle: (ids: readonly string[], isOn: boolean) => void
}

function Row({ topic, row, chosen, isFull, onToggle }: RowProps) {
  const ids = row.fields.map((field) => idOf(topic, field))
  const on = ids.filter((id) => chosen.includes(id)).length
  const isWhole = row.fields.length > 1
  return (
    <div className="field-row">
      <Checkbox
        size="xs"
        label={
          <>
            {isWhole ? row.name : (row.fields[0]?.label ?? row.name)} {row.unit && <span className="quiet">{row.unit}</span>}
          </>
        }
        aria-label={isWhole ? `All of ${row.name} of ${topic}` : `${row.fields[0]?.label ?? row.name} of ${topic}`}
        checked={on === ids.length}
        indeterminate={on > 0 && on < ids.length}
        disabled={isFull && on === 0}
        onChange={(event) => onToggle(ids, event.currentTarget.checked)}
      />
      {isWhole && (
        <div className="field-parts">
          {row.fields.map((field, index) => {
            const id = ids[index] ?? ''
            const isOn = chosen.includes(id)
            const word = field.label.slice(row.name.length).trim()
            return (
              <button
                key={id}
                type="button"
                className="field-part"
                aria-pressed={isOn}
                aria-label={`${field.label} of ${topic}`}
                disabled={isFull && !isOn}
                onClick={() => onToggle([id], !isOn)}
              >
                {word}
              </button>
            )
          })}
        </div>
      )}
    </div>
  )
}

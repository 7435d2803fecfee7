/** The taught entries and the two actions of the tool; each click adds one to the end of the steps. */
import { IconArrowsHorizontal, IconMapPin, IconRoute, IconSearch } from '@tabler/icons-react'
import { useState } from 'react'
import type { EntryName } from '../../api/types'
import { KIND_WORDS, teachable, type Kind } from '../../document/demonstration'

export interface EntryChoiceProps {
  readonly entries: readonly EntryName[] | undefined
  readonly onAdd: (kind: Kind, name: string) => void
}

export function EntryChoice({ entries, onAdd }: EntryChoiceProps) {
  const [text, setText] = useState('')
  const all = teachable(entries ?? [])
  const words = text.toLowerCase().split(/\s+/).filter(Boolean)
  const fitting = all.filter((entry) => words.every((word) => `${entry.name} ${KIND_WORDS[entry.kind]}`.includes(word)))
  return (
    <section className="taught" aria-label="Taught entries">
      <h3>Add</h3>
      <div className="taught-actions">
        <button type="button" className="command" onClick={() => onAdd('action', 'close')}>
          Close gripper
        </button>
        <button type="button" className="command" onClick={() => onAdd('action', 'open')}>
          Open gripper
        </button>
      </div>
      <label className="taught-search">
        <IconSearch size={14} aria-hidden />
        <input
          aria-label="Find a taught entry"
          placeholder="Find a taught entry"
          value={text}
          onChange={(event) => setText(event.currentTarget.value)}
        />
      </label>
      <ul className="plain-list taught-list">
        {fitting.map((entry) => (
          <li key={`${entry.kind}:${entry.name}`}>
            <button
              type="button"
              className="taught-entry"
              aria-label={`Add ${KIND_WORDS[entry.kind]} ${entry.name}`}
              onClick={() => onAdd(entry.kind, entry.name)}
            >
              <KindIcon kind={entry.kind} />
              <span className="taught-name">{entry.name}</span>
              <span className="quiet">{KIND_WORDS[entry.kind]}</span>
            </button>
          </li>
        ))}
      </ul>
      {entries && fitting.length === 0 && (
        <p className="quiet">{all.length === 0 ? 'Nothing has been taught yet: save poses and motions first.' : 'No entry fits.'}</p>
      )}
    </section>
  )
}

export function KindIcon({ kind }: { kind: Kind }) {
  const Icon =
    kind === 'joints' || kind === 'pose' ? IconMapPin : kind === 'gripper' || kind === 'action' ? IconArrowsHorizontal : IconRoute
  return <Icon size={15} aria-hidden className="taught-icon" />
}

/** The behaviors of the project, to choose one. */
import { CloseButton, TextInput } from '@mantine/core'
import { IconSearch } from '@tabler/icons-react'
import { useState } from 'react'
import { useLive } from '../../api/live'
import type { BehaviorSummary } from '../../api/types'
import { Empty } from '../../components/Empty'
import { StatusIcon } from '../../components/StatusIcon'
import { isActive } from '../../document/live'
import { NewBehavior } from './NewBehavior'

export interface BehaviorListProps {
  readonly behaviors: readonly BehaviorSummary[]
  readonly current: string | undefined
  readonly href: (id: string) => string
  readonly onOpen: (id: string) => void
  /** A new behavior was made; undefined for those who may look only. */
  readonly onMade: ((id: string) => void) | undefined
}

export function BehaviorList({ behaviors, current, href, onOpen, onMade }: BehaviorListProps) {
  const [text, setText] = useState('')
  const runs = useLive((s) => s.runs)
  const active = new Set(runs.filter(isActive).map((run) => run.behavior))
  const query = text.trim().toLowerCase()
  const found = behaviors.filter((b) => `${b.id} ${b.name} ${b.description}`.toLowerCase().includes(query))
  return (
    <nav className="behavior-list" aria-label="Behaviors">
      <div className="side-head">
        <h2 className="side-title">Behaviors</h2>
        {onMade && <NewBehavior onMade={onMade} />}
      </div>
      <TextInput
        size="xs"
        aria-label="Find a behavior"
        placeholder="Find"
        leftSection={<IconSearch size={14} aria-hidden />}
        rightSection={text && <CloseButton size="xs" aria-label="Clear" onClick={() => setText('')} />}
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
      />
      {found.length === 0 && (
        <Empty title={behaviors.length === 0 ? 'No behaviors' : 'None matches'}>
          {behaviors.length === 0 ? 'Put a YAML document below behaviors/.' : 'Try another word.'}
        </Empty>
      )}
      <ul className="plain-list">
        {found.map((behavior) => (
          <li key={behavior.id}>
            <a
              href={href(behavior.id)}
              className={`side-item${behavior.id === current ? ' is-current' : ''}`}
              aria-current={behavior.id === current ? 'page' : undefined}
              onClick={(event) => {
                if (event.metaKey || event.ctrlKey || event.shiftKey || event.button !== 0) return
                event.preventDefault()
                onOpen(behavior.id)
              }}
            >
              <span className="side-item-name">
                {behavior.name}
                {active.has(behavior.id) && <span className="live-dot" role="img" aria-label="running" />}
              </span>
              <span className="side-item-text">{folderOf(behavior.id)}</span>
              {(behavior.errors > 0 || behavior.warnings > 0) && (
                <span className="side-item-problems">
                  {behavior.errors > 0 && <Count status="failed" count={behavior.errors} word="error" />}
                  {behavior.warnings > 0 && <Count status="warning" count={behavior.warnings} word="warning" />}
                </span>
              )}
            </a>
          </li>
        ))}
      </ul>
    </nav>
  )
}

function Count({ status, count, word }: { status: 'failed' | 'warning'; count: number; word: string }) {
  return (
    <span className={`count is-${status}`}>
      <StatusIcon status={status} size={12} />
      {count} {word}
      {count === 1 ? '' : 's'}
    </span>
  )
}

function folderOf(id: string): string {
  const folder = id.split('/').slice(0, -1).join('/')
  return folder.replace(/^behaviors\/?/, '') || 'behaviors'
}

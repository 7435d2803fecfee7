/** The behaviors of the project, to choose one. */
import { CloseButton, TextInput } from '@mantine/core'
import { IconSearch } from '@tabler/icons-react'
import { useState } from 'react'
import { useLive } from '../../api/live'
import type { BehaviorSummary } from '../../api/types'
import { Empty } from '../../components/Empty'
import { StatusIcon } from '../../components/StatusIcon'
import { isActive } from '../../document/runState'
import { parentPath } from '../../document/path'
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
  const others = found.filter((behavior) => !fits(behavior))
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
        {found.filter(fits).map((behavior) => (
          <Item key={behavior.id} {...{ behavior, current, href, onOpen }} isRunning={active.has(behavior.id)} />
        ))}
      </ul>
      {others.length > 0 && (
        <details className="other-cells" open={query !== '' || others.some((behavior) => behavior.id === current)}>
          <summary>Of other cells ({others.length})</summary>
          <p className="quiet">They cannot be started in this cell.</p>
          <ul className="plain-list">
            {others.map((behavior) => (
              <Item key={behavior.id} {...{ behavior, current, href, onOpen }} isRunning={false} />
            ))}
          </ul>
        </details>
      )}
    </nav>
  )
}

function fits(behavior: BehaviorSummary): boolean {
  return behavior.fit.obstacle === ''
}

interface ItemProps extends Pick<BehaviorListProps, 'current' | 'href' | 'onOpen'> {
  readonly behavior: BehaviorSummary
  readonly isRunning: boolean
}

function Item({ behavior, current, href, onOpen, isRunning }: ItemProps) {
  return (
    <li>
      <a
        href={href(behavior.id)}
        className={`side-item${behavior.id === current ? ' is-current' : ''}`}
        aria-current={behavior.id === current ? 'page' : undefined}
        title={behavior.fit.obstacle || undefined}
        onClick={(event) => {
          if (event.metaKey || event.ctrlKey || event.shiftKey || event.button !== 0) return
          event.preventDefault()
          onOpen(behavior.id)
        }}
      >
        <span className="side-item-name">
          {behavior.name}
          {isRunning && <span className="live-dot" role="img" aria-label="active" />}
        </span>
        <span className="side-item-text">{fits(behavior) ? folderOf(behavior.id) : `cell ${behavior.fit.cell}`}</span>
        {(behavior.errors > 0 || behavior.warnings > 0) && (
          <span className="side-item-problems">
            {behavior.errors > 0 && <Count status="failed" count={behavior.errors} word="error" />}
            {behavior.warnings > 0 && <Count status="warning" count={behavior.warnings} word="warning" />}
          </span>
        )}
      </a>
    </li>
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
  const folder = parentPath(id)
  return folder.replace(/^behaviors\/?/, '') || 'behaviors'
}

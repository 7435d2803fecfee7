/** The behavior as a tree of text: what the graph shows, for keyboard and screen reader. */
import { Flex, Text, VisuallyHidden } from '@mantine/core'
import { IconChevronDown, IconChevronRight } from '@tabler/icons-react'
import { useMemo, useRef, useState, type KeyboardEvent } from 'react'
import { useNodeLive } from '../../api/liveParts'
import type { GraphNode } from '../../api/types'
import { KindIcon } from '../../components/KindIcon'
import { StatusIcon } from '../../components/StatusIcon'
import { statusOf } from '../../document/runState'
import { kindLabel } from '../../document/tree'

export interface OutlineProps {
  readonly root: GraphNode
  readonly selected: string | undefined
  readonly onSelect: (path: string) => void
}

interface Row {
  readonly node: GraphNode
  readonly level: number
  readonly parent: string | undefined
}

function rowsOf(node: GraphNode, closed: ReadonlySet<string>, level = 1, parent?: string): Row[] {
  const below = closed.has(node.path) ? [] : node.children
  return [{ node, level, parent }, ...below.flatMap((child) => rowsOf(child, closed, level + 1, node.path))]
}

export function Outline({ root, selected, onSelect }: OutlineProps) {
  const [closed, setClosed] = useState<ReadonlySet<string>>(new Set())
  const [focused, setFocused] = useState(root.path)
  const rows = useMemo(() => rowsOf(root, closed), [root, closed])
  const tree = useRef<HTMLUListElement>(null)
  const reachable = rows.some((row) => row.node.path === focused) ? focused : root.path

  function toggle(path: string, shut: boolean): void {
    const next = new Set(closed)
    if (shut) next.add(path)
    else next.delete(path)
    setClosed(next)
  }

  function focus(path: string | undefined): void {
    if (path === undefined) return
    setFocused(path)
    tree.current?.querySelector<HTMLElement>(`[data-path="${CSS.escape(path)}"]`)?.focus()
  }

  function onKeyDown(event: KeyboardEvent, index: number): void {
    const row = rows[index]
    if (!row) return
    const hasChildren = row.node.children.length > 0
    const isOpen = hasChildren && !closed.has(row.node.path)
    const actions: Record<string, () => void> = {
      ArrowDown: () => focus(rows[index + 1]?.node.path),
      ArrowUp: () => focus(rows[index - 1]?.node.path),
      Home: () => focus(rows[0]?.node.path),
      End: () => focus(rows[rows.length - 1]?.node.path),
      ArrowRight: () => (isOpen ? focus(rows[index + 1]?.node.path) : hasChildren && toggle(row.node.path, false)),
      ArrowLeft: () => (isOpen ? toggle(row.node.path, true) : focus(row.parent)),
      Enter: () => onSelect(row.node.path),
      ' ': () => onSelect(row.node.path),
    }
    const action = actions[event.key]
    if (!action) return
    event.preventDefault()
    action()
  }

  return (
    <ul
      className="plain-list"
      style={{ flex: 1, minHeight: 0, padding: '8px 6px', overflow: 'auto' }}
      role="tree"
      aria-label="Outline of the behavior"
      ref={tree}
    >
      {rows.map((row, index) => (
        <OutlineRow
          key={row.node.path}
          row={row}
          isClosed={closed.has(row.node.path)}
          isSelected={row.node.path === selected}
          isReachable={row.node.path === reachable}
          onSelect={() => {
            setFocused(row.node.path)
            onSelect(row.node.path)
          }}
          onToggle={() => toggle(row.node.path, !closed.has(row.node.path))}
          onKeyDown={(event) => onKeyDown(event, index)}
        />
      ))}
    </ul>
  )
}

interface OutlineRowProps {
  readonly row: Row
  readonly isClosed: boolean
  readonly isSelected: boolean
  readonly isReachable: boolean
  readonly onSelect: () => void
  readonly onToggle: () => void
  readonly onKeyDown: (event: KeyboardEvent) => void
}

function OutlineRow({ row, isClosed, isSelected, isReachable, onSelect, onToggle, onKeyDown }: OutlineRowProps) {
  const { node, level } = row
  const live = useNodeLive(node.path)
  const status = statusOf(live?.status ?? 'idle')
  const hasChildren = node.children.length > 0
  const Chevron = isClosed ? IconChevronRight : IconChevronDown
  const words = status === 'done' || status === 'failed' ? `${status}: ${live?.outcome ?? ''}` : status
  return (
    <Flex
      component="li"
      role="treeitem"
      className="pick-row"
      align="center"
      gap={7}
      py={3}
      pr={8}
      pl={8 + (level - 1) * 16}
      bdrs="sm"
      data-path={node.path}
      aria-level={level}
      aria-selected={isSelected}
      {...(hasChildren ? { 'aria-expanded': !isClosed } : {})}
      tabIndex={isReachable ? 0 : -1}
      onClick={onSelect}
      onKeyDown={onKeyDown}
    >
      <span
        style={{ display: 'inline-flex', flex: 'none', width: 14, color: 'var(--quiet)' }}
        aria-hidden
        onClick={(event) => {
          event.stopPropagation()
          if (hasChildren) onToggle()
        }}
      >
        {hasChildren && <Chevron size={14} />}
      </span>
      <StatusIcon status={status} size={14} />
      <KindIcon icon={node.icon} size={14} />
      <Text span inherit fw={550}>
        {node.name}
      </Text>
      <Text span truncate fz="0.78rem" c="var(--quiet)">
        {node.title || kindLabel(node.kind)}
      </Text>
      <VisuallyHidden component="span">{words}</VisuallyHidden>
      {live && live.visits > 1 && (
        <Text span ml="auto" fz="xs" c="var(--quiet)">
          ×{live.visits}
        </Text>
      )}
    </Flex>
  )
}

/** The names beside the bars: a tree of which only the rows in sight are in the page. */
import { Box, Flex, Text } from '@mantine/core'
import { IconChevronDown, IconChevronRight } from '@tabler/icons-react'
import { useRef, useState, type KeyboardEvent } from 'react'
import type { ActivationInterval, GraphNode } from '../../api/types'
import { KindIcon } from '../../components/KindIcon'
import { StatusIcon } from '../../components/StatusIcon'
import { statusOf } from '../../document/runState'
import { spanAt, type ShownRow } from '../../document/timeline'
import { kindLabel } from '../../document/tree'
import { ROW } from './draw'
import classes from './Timeline.module.css'

export interface NamesProps {
  readonly rows: readonly ShownRow[]
  /** The nodes of the graph by path; a run may know others. */
  readonly nodes: ReadonlyMap<string, GraphNode>
  readonly spans: ReadonlyMap<string, readonly ActivationInterval[]>
  readonly selected: string | undefined
  readonly cursorS: number
  readonly topPx: number
  readonly heightPx: number
  readonly onShow: (path: string) => void
  readonly onToggle: (path: string) => void
}

const BEYOND = 4

export function Names({ rows, nodes, spans, selected, cursorS, topPx, heightPx, onShow, onToggle }: NamesProps) {
  const tree = useRef<HTMLUListElement>(null)
  const [reached, setReached] = useState(0)
  const first = Math.max(0, Math.floor(topPx / ROW) - BEYOND)
  const last = Math.min(rows.length, Math.ceil((topPx + heightPx) / ROW) + BEYOND)
  const reachable = Math.min(Math.max(reached, first), Math.max(last - 1, 0))

  function focus(index: number): void {
    const to = Math.min(Math.max(index, 0), rows.length - 1)
    setReached(to)
    const scroller = tree.current?.parentElement?.parentElement
    if (scroller) {
      if (to * ROW < scroller.scrollTop) scroller.scrollTop = to * ROW
      else if ((to + 1) * ROW > scroller.scrollTop + scroller.clientHeight) scroller.scrollTop = (to + 1) * ROW - scroller.clientHeight
    }
    // A row that was out of sight is made first.
    requestAnimationFrame(() => tree.current?.querySelector<HTMLElement>(`[data-index="${to}"]`)?.focus({ preventScroll: true }))
  }

  function onKeyDown(event: KeyboardEvent, index: number, row: ShownRow): void {
    const parent = rows.findLastIndex((each, at) => at < index && each.depth < row.depth)
    const actions: Record<string, () => void> = {
      ArrowDown: () => focus(index + 1),
      ArrowUp: () => focus(index - 1),
      Home: () => focus(0),
      End: () => focus(rows.length - 1),
      ArrowRight: () => (row.hasChildren && !row.isOpen ? onToggle(row.path) : focus(index + 1)),
      ArrowLeft: () => (row.hasChildren && row.isOpen ? onToggle(row.path) : parent >= 0 && focus(parent)),
      Enter: () => onShow(row.path),
      ' ': () => onShow(row.path),
    }
    const action = actions[event.key]
    if (!action) return
    event.preventDefault()
    event.stopPropagation()
    action()
  }

  return (
    <ul className={`${classes.names} plain-list`} role="tree" aria-label="Nodes of the timeline" ref={tree}>
      {rows.slice(first, last).map((row, offset) => {
        const index = first + offset
        const node = nodes.get(row.path)
        const status = statusAt(spans.get(row.path) ?? [], cursorS)
        const Chevron = row.isOpen ? IconChevronDown : IconChevronRight
        return (
          <Flex
            component="li"
            key={row.path}
            role="treeitem"
            pos="absolute"
            align="center"
            gap={4}
            w="100%"
            pr={6}
            className="pick-row"
            style={{ top: index * ROW, height: ROW, paddingInlineStart: 4 + Math.min(row.depth, 8) * 11 }}
            data-index={index}
            title={row.path}
            aria-level={row.depth + 1}
            aria-setsize={rows.length}
            aria-posinset={index + 1}
            aria-selected={row.path === selected}
            {...(row.hasChildren ? { 'aria-expanded': row.isOpen } : {})}
            tabIndex={index === reachable ? 0 : -1}
            onClick={() => {
              setReached(index)
              onShow(row.path)
            }}
            onKeyDown={(event) => onKeyDown(event, index, row)}
          >
            <Box
              component="span"
              flex="none"
              w={13}
              c="dimmed"
              lh={0}
              aria-hidden
              onClick={(event) => {
                event.stopPropagation()
                if (row.hasChildren) onToggle(row.path)
              }}
            >
              {row.hasChildren && <Chevron size={13} />}
            </Box>
            <StatusIcon status={statusOf(status)} size={12} />
            {node && <KindIcon icon={node.icon} title={node.title || kindLabel(node.kind)} size={12} />}
            <Text span inherit truncate>
              {row.name}
            </Text>
          </Flex>
        )
      })}
    </ul>
  )
}

/** How a node was at a time: active, as it was left last, or idle before its first visit. */
function statusAt(spans: readonly ActivationInterval[], timeS: number): string {
  const span = spanAt(spans, timeS, Infinity)
  if (!span || span.start_s > timeS) return 'idle'
  return span.end_s === null || span.end_s > timeS ? 'active' : span.status
}

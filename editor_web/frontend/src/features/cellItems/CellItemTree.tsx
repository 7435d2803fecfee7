/** The tree of the cell, with the state of each item beside it. */
import { getTreeExpandedState, Group, ScrollArea, Text, Tree, useTree, type RenderTreeNodePayload, type TreeNodeData } from '@mantine/core'
import {
  IconAlertTriangle,
  IconBox,
  IconCamera,
  IconChevronRight,
  IconCube3dSphere,
  IconDatabase,
  IconGridDots,
  IconHandGrab,
  IconLink,
  IconMap,
  IconPlugConnected,
  IconPuzzle,
  IconRobot,
  IconSettingsAutomation,
  IconTable,
  IconUser,
  IconVector,
  IconWorld,
  type Icon,
} from '@tabler/icons-react'
import { useEffect, useMemo } from 'react'
import { StatusIcon } from '../../components/StatusIcon'
import { ancestorsOf, nodeAt, stateWords, type CellNode, type CellNow, type NodeKind } from '../../document/cellTree'
import classes from './cellItems.module.css'

const ICONS: Readonly<Record<NodeKind, Icon>> = {
  group: IconGridDots,
  robot: IconRobot,
  tool: IconHandGrab,
  equipment: IconPlugConnected,
  device: IconSettingsAutomation,
  bond: IconLink,
  module: IconPuzzle,
  fixture: IconTable,
  part: IconBox,
  camera: IconCamera,
  person: IconUser,
  occupancy: IconMap,
  world: IconWorld,
  store: IconDatabase,
  frame: IconVector,
}

interface CellItemTreeProps {
  readonly tree: readonly CellNode[]
  readonly now: CellNow
  /** The address of the selected item, empty for none. */
  readonly selected: string
  /** The paths of items in which the document under edit has errors. */
  readonly faulty: ReadonlySet<string>
  /** The paths of items that touch something while everything is at rest. */
  readonly touching: ReadonlySet<string>
  readonly onSelect: (address: string) => void
}

export function CellItemTree({ tree, now, selected, faulty, touching, onSelect }: CellItemTreeProps) {
  const data = useMemo(() => tree.map(dataOf), [tree])
  // Groups of items are open at first; the many frames of arms are not.
  const controller = useTree({
    initialExpandedState: getTreeExpandedState(
      data,
      tree.flatMap((node) => (node.address === 'group:frames' ? [] : [node.address, ...node.children.map((child) => child.address)])),
    ),
    selectedState: selected ? [selected] : [],
    onSelectedStateChange: ([address]) => address !== undefined && choose(address),
  })
  const { expand, toggleExpanded } = controller

  /** A group has nothing to show: it folds. */
  function choose(address: string): void {
    if (nodeAt(tree, address)?.kind === 'group') toggleExpanded(address)
    else onSelect(address)
  }

  useEffect(() => {
    for (const address of ancestorsOf(tree, selected)) expand(address)
    // oxlint-disable-next-line react/exhaustive-deps -- once for each selection: what a person folds stays folded
  }, [selected])
  return (
    <ScrollArea h="100%" p="xs" viewportProps={{ tabIndex: -1 }}>
      <Tree
        aria-label="Items of the cell"
        onKeyDown={(event) => {
          const address = event.key === 'Enter' ? addressOf(event.target) : undefined
          if (address === undefined) return
          event.preventDefault()
          choose(address)
        }}
        data={data}
        tree={controller}
        selectOnClick
        expandOnClick={false}
        levelOffset="md"
        allowRangeSelection={false}
        renderNode={(payload) => (
          <Line {...payload} cell={nodeAt(tree, payload.node.value)} now={now} faulty={faulty} touching={touching} />
        )}
      />
    </ScrollArea>
  )
}

function addressOf(target: EventTarget): string | undefined {
  return target instanceof HTMLElement ? target.closest<HTMLElement>('[role=treeitem]')?.dataset.value : undefined
}

function dataOf(node: CellNode): TreeNodeData {
  return {
    value: node.address,
    label: node.name,
    ...(node.children.length > 0 && { children: node.children.map(dataOf) }),
  }
}

function Line({
  cell,
  now,
  faulty,
  touching,
  expanded,
  hasChildren,
  selected,
  elementProps,
  tree,
}: RenderTreeNodePayload & {
  readonly cell: CellNode | undefined
  readonly now: CellNow
  readonly faulty: ReadonlySet<string>
  readonly touching: ReadonlySet<string>
}) {
  if (!cell) return null
  const Kind = ICONS[cell.kind] ?? IconCube3dSphere
  const state = stateWords(cell, now)
  return (
    <Group
      {...elementProps}
      gap={6}
      wrap="nowrap"
      className={`${elementProps.className} ${classes.line} pick-row`}
      data-selected={selected || undefined}
    >
      <IconChevronRight
        size={13}
        aria-hidden
        className={classes.chevron}
        data-open={expanded || undefined}
        data-none={!hasChildren || undefined}
        onClick={(event) => {
          event.stopPropagation()
          tree.toggleExpanded(cell.address)
        }}
      />
      <Kind size={15} stroke={1.6} aria-hidden />
      <Text span size="sm" fw={cell.kind === 'group' ? 600 : 400} truncate>
        {cell.name}
      </Text>
      {cell.detail && (
        <Text span size="xs" c="dimmed" truncate>
          {cell.detail}
        </Text>
      )}
      {cell.item && faulty.has(cell.item.path) && (
        <Text span size="xs" c="var(--failed)" style={{ whiteSpace: 'nowrap' }}>
          <IconAlertTriangle size={13} aria-hidden /> has an error
        </Text>
      )}
      {cell.item && touching.has(cell.item.path) && (
        <Text span size="xs" c="var(--stopped)" style={{ whiteSpace: 'nowrap' }}>
          <IconAlertTriangle size={13} aria-hidden /> touches something
        </Text>
      )}
      {cell.kind === 'group' && (
        <Text span size="xs" c="dimmed">
          {cell.children.length}
        </Text>
      )}
      {state && (
        <Group component="span" gap={4} wrap="nowrap" ml="auto">
          {(cell.kind === 'robot' || state.look !== 'idle') && <StatusIcon status={state.look} size={13} />}
          <Text span size="xs" c="dimmed" style={{ fontVariantNumeric: 'tabular-nums', whiteSpace: 'nowrap' }}>
            {state.words}
          </Text>
        </Group>
      )}
    </Group>
  )
}

/** The page of the cell, for reading: what it consists of, where that is, and what it does now. */
import { Box } from '@mantine/core'
import { useMemo, useState } from 'react'
import { Group, Panel as Pane } from 'react-resizable-panels'
import { Refusal } from '../components/Refusal'
import { cellDevicesQuery, cellItemsQuery } from '../api/cellItems'
import { useData } from '../api/data'
import { useLive } from '../api/live'
import { useAnswer } from '../api/queryClient'
import { hasCellView } from '../api/session'
import type { CellStateFrame, SessionBody } from '../api/types'
import { Empty } from '../components/Empty'
import { OpenedTabs } from '../components/OpenedTabs'
import { PageHead } from '../components/PageHead'
import { Panel } from '../components/Panel'
import { Splitter } from '../components/Splitter'
import { cellTree, deviceOf, nodeAt } from '../document/cellTree'
import { CellFrame } from '../features/cell/CellFrame'
import { DriverSwitch } from '../features/cell/DriverSwitch'
import { ShowMenu } from '../features/cell/ShowMenu'
import { CellItemTree } from '../features/cellItems/CellItemTree'
import { ItemDetails } from '../features/cellItems/ItemDetails'
import { DevicePanel } from '../features/devices/DevicePanel'
import { RobotStrip } from '../features/robots/RobotStrip'
import { cellHref, TEACH_HREF } from './route'

interface CellPageProps {
  /** The address of the selected item, empty for none. */
  readonly item: string
  readonly session: SessionBody | undefined
  readonly isNarrow: boolean
  readonly onOpen: (href: string) => void
}

export function CellPage({ item, session, isNarrow, onOpen }: CellPageProps) {
  const { value: cell, problem } = useAnswer(cellItemsQuery())
  const { value: devices } = useAnswer(cellDevicesQuery((session?.devices ?? []).length > 0))
  const [state, setState] = useState<CellStateFrame>()
  useData({ number: 0, traffic: false, topic: '', fields: [], run: '', goals: '', cell: true }, (frame) => {
    if (frame.k === 'cell') setState(frame)
  })
  const robots = useLive((s) => s.robots)
  // The names of the frames and not their poses: the tree stays the same while an arm moves.
  const frames = Object.keys(state?.poses ?? {}).join('\n')
  const tree = useMemo(() => cellTree(cell?.items ?? [], frames ? frames.split('\n') : []), [cell, frames])
  // What is selected comes to the front, each time that something is.
  const asked = useMemo(() => (item ? { tab: 'Details' } : undefined), [item])
  if (problem) return <Empty title="The cell cannot be read">{problem}</Empty>
  if (!cell) return <div role="status" aria-label="Loading" />
  const now = { robots, state }
  const node = nodeAt(tree, item)
  const select = (address: string) => onOpen(cellHref(address))
  const items = (
    <Panel title="Items">
      <CellItemTree tree={tree} now={now} selected={item} onSelect={select} />
    </Panel>
  )
  const driven = devices?.find((each) => `robots/${each.device}` === node?.item?.path)
  const panel = node ? (
    <ItemDetails
      node={node}
      cell={cell}
      now={now}
      hasCellView={hasCellView(session)}
      onSelect={select}
      onTeach={session?.role === 'operator' ? () => onOpen(TEACH_HREF) : undefined}
      device={driven && <DevicePanel key={driven.device} details={driven} now={deviceOf(node, state)} />}
    />
  ) : (
    <Panel title="Details">
      {item ? (
        <Empty title="This cell has no such item">{item}</Empty>
      ) : (
        <Empty title="Nothing is selected">Select an item of the tree.</Empty>
      )}
    </Panel>
  )
  const view = (
    <Panel
      title="Cell"
      hasIcons
      tools={
        <>
          <Box flex={1} />
          {hasCellView(session) && <ShowMenu />}
        </>
      }
      foot={<RobotStrip />}
    >
      <CellFrame />
    </Panel>
  )
  return (
    <>
      <PageHead title={cell.cell} words={cell.description}>
        <DriverSwitch session={session} />
      </PageHead>
      {session?.opening_problem && (
        <Refusal isWide title="The cell was not opened as it was asked for.">
          It is open as it was before. {session.opening_problem}
        </Refusal>
      )}
      {isNarrow ? (
        <OpenedTabs label="Cell" bodies={{ Items: items, Details: panel, '3D view': view }} asked={asked} />
      ) : (
        <Group orientation="horizontal" style={{ flex: 1, minHeight: 0 }}>
          <Pane id="cell-items" defaultSize="30%" minSize="18%">
            {items}
          </Pane>
          <Splitter label="Width of the items" />
          <Pane id="cell-view" defaultSize="42%" minSize="20%">
            {view}
          </Pane>
          <Splitter label="Width of the cell" />
          <Pane id="cell-details" defaultSize="28%" minSize="18%">
            {panel}
          </Pane>
        </Group>
      )}
    </>
  )
}

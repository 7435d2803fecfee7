/** The page of the cell: what it consists of, where that is, what it does now; and the editor of its document. */
import { Box, Button } from '@mantine/core'
import { IconPencil } from '@tabler/icons-react'
import { useQueryClient } from '@tanstack/react-query'
import { useMemo, useState } from 'react'
import { Group, Panel as Pane } from 'react-resizable-panels'
import { Refusal } from '../components/Refusal'
import { cellDocumentsQuery, modelNamesQuery } from '../api/cellDocuments'
import { cellDevicesQuery, cellItemsQuery } from '../api/cellItems'
import { useData } from '../api/data'
import { useLive } from '../api/live'
import { useAnswer } from '../api/queryClient'
import { queryKeys } from '../api/queryKeys'
import { hasCellView } from '../api/session'
import type { CellDocumentName, CellStateFrame, ModelNames, SessionBody } from '../api/types'
import { Empty } from '../components/Empty'
import { lazyView } from '../components/lazyView'
import { OpenedTabs } from '../components/OpenedTabs'
import { PageHead } from '../components/PageHead'
import { Panel } from '../components/Panel'
import { Splitter } from '../components/Splitter'
import { itemAt, itemsOfDraft, surroundingsOf } from '../document/cellEditing'
import { placeToMeasure } from '../document/cellMeasure'
import { cellTree, deviceOf, nodeAt } from '../document/cellTree'
import { CellFrame } from '../features/cell/CellFrame'
import { DriverSwitch } from '../features/cell/DriverSwitch'
import { ExportMenu } from '../features/cell/ExportMenu'
import { ShowMenu } from '../features/cell/ShowMenu'
import { AddMenu } from '../features/cellEditor/AddMenu'
import { EditorBar } from '../features/cellEditor/EditorBar'
import { ItemForm } from '../features/cellEditor/ItemForm'
import { openCellDocument } from '../features/cellEditor/session'
import { draftOf, useCellEditor } from '../features/cellEditor/store'
import { CellItemTree } from '../features/cellItems/CellItemTree'
import { ModulePlugging } from '../features/modules/ModulePlugging'
import { ItemDetails } from '../features/cellItems/ItemDetails'
import { Measure } from '../features/cellItems/Measure'
import { DevicePanel } from '../features/devices/DevicePanel'
import { RobotStrip } from '../features/robots/RobotStrip'
import { cellHref, TEACH_HREF } from './route'

const CellText = lazyView(async () => (await import('../features/cellEditor/CellText')).CellText)
const NO_MODELS: ModelNames = { robots: [], tools: [] }
const NO_DOCUMENTS: readonly CellDocumentName[] = []

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
  const mayEdit = session?.role === 'operator'
  const { value: documents = NO_DOCUMENTS } = useAnswer(cellDocumentsQuery(mayEdit))
  const phase = useCellEditor((s) => s.phase)
  const draft = useCellEditor((s) => (s.phase === 'ready' ? draftOf(s) : undefined))
  const rest = useCellEditor((s) => s.rest)
  const [measuredFrom, setMeasuredFrom] = useState('')
  const client = useQueryClient()
  const tree = useMemo(() => {
    const shown = frames && draft?.kind !== 'module' ? frames.split('\n') : []
    return cellTree(draft ? itemsOfDraft(draft, cell?.items ?? []) : (cell?.items ?? []), shown)
  }, [cell, frames, draft])
  const folders = useMemo(() => documents.flatMap((each) => each.folder || []), [documents])
  const { value: models = NO_MODELS } = useAnswer(modelNamesQuery(draft !== undefined))
  const surroundings = useMemo(() => draft && surroundingsOf(draft, { folders, ...models }), [draft, folders, models])
  // What is selected comes to the front, each time that something is.
  const asked = useMemo(() => (item ? { tab: 'Details' } : undefined), [item])
  if (problem) return <Empty title="The cell cannot be read">{problem}</Empty>
  if (!cell) return <div role="status" aria-label="Loading" />
  const now = { robots, state }
  const node = nodeAt(tree, item)
  const select = (address: string) => onOpen(cellHref(address))
  const edited = draft && itemAt(draft, item)
  const faulty = new Set(draft?.findings.map((each) => each.path))
  const touching = new Set(rest.map((each) => each.path))
  const measurable = (address: string) => {
    const of = nodeAt(tree, address)
    const pose = of && placeToMeasure(of, draft, state)
    return of && pose && { address, name: of.name, pose }
  }
  const items = (
    <Panel
      title="Items"
      foot={<Measure from={measurable(measuredFrom)} to={measurable(item)} onFrom={setMeasuredFrom} />}
      tools={
        surroundings && (
          <AddMenu
            surroundings={surroundings}
            taken={cell.items.filter((each) => !each.owner).map((each) => each.name)}
            onSelect={select}
          />
        )
      }
    >
      <CellItemTree key={draft?.kind} tree={tree} now={now} selected={item} faulty={faulty} touching={touching} onSelect={select} />
    </Panel>
  )
  const driven = devices?.find((each) => `robots/${each.device}` === node?.item?.path)
  const read = node ? (
    <ItemDetails
      node={node}
      cell={cell}
      now={now}
      hasCellView={hasCellView(session)}
      onSelect={select}
      onTeach={session?.role === 'operator' ? () => onOpen(TEACH_HREF) : undefined}
      device={
        node.kind === 'module' && mayEdit && !node.name.includes('/') ? (
          <ModulePlugging key={node.name} module={node.name} />
        ) : (
          driven && <DevicePanel key={driven.device} details={driven} now={deviceOf(node, state)} />
        )
      }
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
  const properties =
    edited && surroundings ? (
      <Panel title={`${edited.section}/${edited.name}`}>
        <ItemForm
          key={`${edited.section}/${edited.name} ${JSON.stringify(edited.value)}`}
          item={edited}
          surroundings={surroundings}
          onSelect={select}
        />
      </Panel>
    ) : (
      read
    )
  const text = (
    <Panel title="Document">
      <CellText selected={item} onSelect={select} />
    </Panel>
  )
  const panel = draft ? (
    <Group orientation="vertical" style={{ height: '100%' }}>
      <Pane id="cell-properties" defaultSize="58%" minSize="20%">
        {properties}
      </Pane>
      <Splitter label="Height of the properties" />
      <Pane id="cell-text" defaultSize="42%" minSize="12%">
        {text}
      </Pane>
    </Group>
  ) : (
    read
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
        {phase === 'closed' && mayEdit && documents[0] && (
          <Button
            size="xs"
            variant="default"
            leftSection={<IconPencil size={14} aria-hidden />}
            onClick={() => documents[0] && void openCellDocument(documents[0].id)}
          >
            Edit the cell
          </Button>
        )}
        {cell.file && <ExportMenu file={cell.file} />}
        <DriverSwitch session={session} />
      </PageHead>
      {phase !== 'closed' && (
        <EditorBar
          documents={documents}
          session={session}
          isChanged={cell.changed}
          onSaved={() => void client.invalidateQueries({ queryKey: queryKeys.cellItems })}
        />
      )}
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

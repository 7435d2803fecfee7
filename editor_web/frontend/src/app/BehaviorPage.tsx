/** The page of a behavior: head, graph, log, cell, parameters, outline and problems. */
import { Button, Tabs } from '@mantine/core'
import { IconPlayerPlayFilled } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { Group, Panel as Pane, Separator } from 'react-resizable-panels'
import { api } from '../api/client'
import type { BehaviorBody, RunLine, SessionBody } from '../api/types'
import { Empty } from '../components/Empty'
import { Panel } from '../components/Panel'
import { StatusBadge } from '../components/StatusBadge'
import { isActive } from '../document/live'
import { nodeAt, pathsTo } from '../document/tree'
import { CellFrame } from '../features/cell/CellFrame'
import { ResetParts } from '../features/cell/ResetParts'
import { FindingList } from '../features/findings/FindingList'
import { Graph } from '../features/graph/Graph'
import { Outline } from '../features/graph/Outline'
import { Selection } from '../features/graph/Selection'
import { EventLog } from '../features/log/EventLog'
import { FORM_ID, ParameterForm } from '../features/parameters/ParameterForm'
import { useFetched } from './useFetched'

export interface BehaviorPageProps {
  readonly id: string
  /** The run that is shown, if any. */
  readonly run: RunLine | undefined
  /** The run that occupies the cell, if any. */
  readonly busyWith: RunLine | undefined
  readonly session: SessionBody | undefined
  readonly isNarrow: boolean
  readonly onStarted: () => void
}

export function BehaviorPage(props: BehaviorPageProps) {
  const { id } = props
  const fetched = useFetched(id, () => api.behavior(id))
  if (fetched.problem) return <Empty title="This behavior cannot be shown">{fetched.problem}</Empty>
  if (!fetched.value) return <div className="page-wait" role="status" aria-label="Loading" />
  return <Loaded {...props} behavior={fetched.value} />
}

function Loaded({ behavior, run, busyWith, session, isNarrow, onStarted }: BehaviorPageProps & { behavior: BehaviorBody }) {
  const [selected, setSelected] = useState<string>()
  const obstacle = obstacleOf(behavior, busyWith, session)
  const node = behavior.graph && selected ? nodeAt(behavior.graph, selected) : undefined

  const graph = behavior.graph ? (
    <Graph
      root={behavior.graph}
      selected={selected}
      onSelect={setSelected}
      breadcrumb={<Breadcrumb selected={selected} onSelect={setSelected} />}
    />
  ) : (
    <Panel title="Graph">
      <Empty title="There is no graph to draw">The document cannot be read; see its problems.</Empty>
    </Panel>
  )
  const cell = (
    <Panel title="Cell" className="cell-panel" tools={session?.role === 'operator' && <ResetParts isBusy={busyWith !== undefined} />}>
      <CellFrame isServed={session?.has_cell_view ?? false} />
    </Panel>
  )
  const parameters = (
    <div className="tab-body">
      <ParameterForm behavior={behavior} obstacle={obstacle} onStarted={onStarted} />
    </div>
  )
  const outline = (
    <div className="tab-body is-flush">
      {behavior.graph && <Outline root={behavior.graph} selected={selected} onSelect={setSelected} />}
      {node && <Selection node={node} />}
    </div>
  )
  const problems = (
    <div className="tab-body">
      <FindingList document={behavior.id} findings={behavior.findings} onSelect={setSelected} />
    </div>
  )

  return (
    <div className="behavior-page">
      <header className="page-head">
        <div className="page-head-text">
          <h1>{behavior.name}</h1>
          {behavior.description && <p className="quiet">{behavior.description}</p>}
        </div>
        {run && <StatusBadge status={run.status} outcome={run.outcome} success={run.success} />}
        {run && !isActive(run) && run.cause && <span className="page-cause" title={run.cause}>{run.cause}</span>}
        <span className="spacer" />
        <Button
          type="submit"
          form={FORM_ID}
          size="sm"
          leftSection={<IconPlayerPlayFilled size={14} aria-hidden />}
          disabled={obstacle !== undefined}
          title={obstacle}
        >
          Start
        </Button>
      </header>
      {isNarrow ? (
        <Narrow views={{ Parameters: parameters, Graph: graph, Cell: cell, Log: <EventLog />, Outline: outline, Problems: problems }} />
      ) : (
        <Wide graph={graph} cell={cell} tabs={<SideTabs behavior={behavior} parameters={parameters} outline={outline} problems={problems} selected={selected} />} />
      )}
    </div>
  )
}

function Wide({ graph, cell, tabs }: { graph: ReactNode; cell: ReactNode; tabs: ReactNode }) {
  return (
    <Group orientation="horizontal" className="work-space">
      <Pane id="left" defaultSize="67%" minSize="30%">
        <Group orientation="vertical">
          <Pane id="graph" defaultSize="71%" minSize="20%">
            {graph}
          </Pane>
          <Separator className="splitter is-flat" aria-label="Height of the graph" />
          <Pane id="log" defaultSize="29%" minSize="12%">
            <EventLog />
          </Pane>
        </Group>
      </Pane>
      <Separator className="splitter" aria-label="Width of the graph" />
      <Pane id="right" defaultSize="33%" minSize="22%">
        <Group orientation="vertical">
          <Pane id="cell" defaultSize="48%" minSize="15%">
            {cell}
          </Pane>
          <Separator className="splitter is-flat" aria-label="Height of the cell" />
          <Pane id="tabs" defaultSize="52%" minSize="15%">
            {tabs}
          </Pane>
        </Group>
      </Pane>
    </Group>
  )
}

interface SideTabsProps {
  readonly behavior: BehaviorBody
  readonly selected: string | undefined
  readonly parameters: ReactNode
  readonly outline: ReactNode
  readonly problems: ReactNode
}

function SideTabs({ behavior, parameters, outline, problems }: SideTabsProps) {
  return (
    <Tabs defaultValue={behavior.errors > 0 ? 'problems' : 'parameters'} className="side-tabs" keepMounted>
      <Tabs.List>
        <Tabs.Tab value="parameters">Parameters</Tabs.Tab>
        <Tabs.Tab value="outline">Outline</Tabs.Tab>
        <Tabs.Tab value="problems">
          Problems{behavior.findings.length > 0 && <span className="tab-count">{behavior.findings.length}</span>}
        </Tabs.Tab>
      </Tabs.List>
      <Tabs.Panel value="parameters">{parameters}</Tabs.Panel>
      <Tabs.Panel value="outline">{outline}</Tabs.Panel>
      <Tabs.Panel value="problems">{problems}</Tabs.Panel>
    </Tabs>
  )
}

/** One view at a time, for small screens. */
function Narrow({ views }: { views: Readonly<Record<string, ReactNode>> }) {
  const names = Object.keys(views)
  return (
    <Tabs defaultValue={names[0] ?? ''} className="side-tabs narrow-tabs" keepMounted>
      <Tabs.List>
        {names.map((name) => (
          <Tabs.Tab key={name} value={name}>
            {name}
          </Tabs.Tab>
        ))}
      </Tabs.List>
      {names.map((name) => (
        <Tabs.Panel key={name} value={name}>
          {views[name]}
        </Tabs.Panel>
      ))}
    </Tabs>
  )
}

function Breadcrumb({ selected, onSelect }: { selected: string | undefined; onSelect: (path: string) => void }) {
  if (!selected) return null
  const paths = pathsTo(selected)
  return (
    <nav aria-label="Path of the selection" className="breadcrumb">
      <ol>
        {paths.map((path) => (
          <li key={path}>
            <button type="button" aria-current={path === selected ? 'location' : undefined} onClick={() => onSelect(path)}>
              {path.split('/').pop()}
            </button>
          </li>
        ))}
      </ol>
    </nav>
  )
}

function obstacleOf(behavior: BehaviorBody, busyWith: RunLine | undefined, session: SessionBody | undefined): string | undefined {
  if (session && session.role !== 'operator') return 'You may look only: log in with the operator token to start runs'
  if (behavior.errors > 0) return 'The document has errors; see its problems'
  return busyWith ? 'The cell is busy with a run' : undefined
}

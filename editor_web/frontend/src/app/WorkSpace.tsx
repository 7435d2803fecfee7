/** How the parts of a behavior's page are placed: panes beside one another, or one view at a time. */
import { Tabs } from '@mantine/core'
import type { ReactNode } from 'react'
import { ViewBoundary } from '../components/ViewBoundary'
import { Group, Panel as Pane, Separator } from 'react-resizable-panels'

export type Tab = 'parameters' | 'node' | 'outline' | 'holds' | 'problems'

/** What can be done with the selected node stands below the graph, for there is no room beside it. */
export function NarrowGraph({ graph, card }: { graph: ReactNode; card: ReactNode }) {
  return (
    <div className="narrow-graph">
      <div className="narrow-canvas">{graph}</div>
      {card && <div className="narrow-card">{card}</div>}
    </div>
  )
}

interface WideProps {
  readonly graph: ReactNode
  readonly log: ReactNode
  readonly cell: ReactNode
  readonly tabs: ReactNode
  /** How much of the height is for what stands below the graph, in percent. */
  readonly below?: number
}

export function Wide({ graph, log, cell, tabs, below = 29 }: WideProps) {
  return (
    <Group orientation="horizontal" className="work-space">
      <Pane id="left" defaultSize="67%" minSize="30%">
        <Group orientation="vertical">
          <Pane id="graph" defaultSize={`${100 - below}%`} minSize="20%">
            <ViewBoundary name="Graph">{graph}</ViewBoundary>
          </Pane>
          <Separator className="splitter is-flat" aria-label="Height of the graph" />
          <Pane id="log" defaultSize={`${below}%`} minSize="12%">
            <ViewBoundary name="Log">{log}</ViewBoundary>
          </Pane>
        </Group>
      </Pane>
      <Separator className="splitter" aria-label="Width of the graph" />
      <Pane id="right" defaultSize="33%" minSize="22%">
        <Group orientation="vertical">
          <Pane id="cell" defaultSize="48%" minSize="15%">
            <ViewBoundary name="Cell">{cell}</ViewBoundary>
          </Pane>
          <Separator className="splitter is-flat" aria-label="Height of the cell" />
          <Pane id="tabs" defaultSize="52%" minSize="15%">
            <ViewBoundary name="Tabs">{tabs}</ViewBoundary>
          </Pane>
        </Group>
      </Pane>
    </Group>
  )
}

const TABS: Record<Tab, string> = {
  parameters: 'Start',
  node: 'Node',
  outline: 'Outline',
  holds: 'Breakpoints',
  problems: 'Problems',
}

interface SideTabsProps {
  readonly tab: Tab
  readonly onTab: (tab: Tab) => void
  readonly counts: Readonly<Partial<Record<Tab, number>>>
  readonly bodies: Readonly<Record<Tab, ReactNode>>
}

export function SideTabs({ tab, onTab, counts, bodies }: SideTabsProps) {
  const names = Object.keys(TABS) as Tab[]
  return (
    <Tabs value={tab} onChange={(value) => onTab((value ?? 'parameters') as Tab)} className="side-tabs" keepMounted>
      <Tabs.List>
        {names.map((name) => (
          <Tabs.Tab key={name} value={name}>
            {TABS[name]}
            {(counts[name] ?? 0) > 0 && <span className="tab-count">{counts[name]}</span>}
          </Tabs.Tab>
        ))}
      </Tabs.List>
      {names.map((name) => (
        <Tabs.Panel key={name} value={name}>
          <ViewBoundary name={TABS[name]}>{bodies[name]}</ViewBoundary>
        </Tabs.Panel>
      ))}
    </Tabs>
  )
}

/** How the parts of a behavior's page are placed: panes beside one another, or one view at a time. */
import { Box, Flex, Tabs } from '@mantine/core'
import type { ReactNode } from 'react'
import { Placed, useMovable } from '../components/Movable'
import { Splitter } from '../components/Splitter'
import { TabCount } from '../components/TabCount'
import { ViewBoundary } from '../components/ViewBoundary'
import { Group, Panel as Pane, useDefaultLayout } from 'react-resizable-panels'
import type { RunLayout } from './runLayout'

export type Tab = 'parameters' | 'node' | 'outline' | 'holds' | 'problems' | 'log' | 'failure'

/** What can be done with the selected node stands below the graph, for there is no room beside it. */
export function NarrowGraph({ graph, card }: { graph: ReactNode; card: ReactNode }) {
  return (
    <Flex direction="column" h="100%">
      <Box flex={1} mih={0}>
        {graph}
      </Box>
      {card && (
        <Box mah="48%" bg="var(--surface)" style={{ overflow: 'auto', borderTop: '1px solid var(--line-strong)' }}>
          {card}
        </Box>
      )}
    </Flex>
  )
}

/** The layouts of the page, and the one while a run asks about a planned path. */
export type Arrangement = RunLayout | 'approval'

interface WideProps {
  readonly arrangement: Arrangement
  readonly graph: ReactNode
  readonly cell: ReactNode
  /** Beside the 3D view for debugging, else below the graph. */
  readonly tabs: ReactNode
  /** Below everything for debugging: what shows the course of the run, and what it said and wrote. */
  readonly course: ReactNode
  readonly records: ReactNode
}

/**
 * The 3D view keeps its place in the tree in every arrangement: its frame would load anew elsewhere.
 * What has another size in another arrangement has another id, so that each keeps its own splits.
 */
export function Wide({ arrangement, cell, course, records, ...moved }: WideProps) {
  const graph = useMovable(<ViewBoundary name="Graph">{moved.graph}</ViewBoundary>)
  const tabs = useMovable(<ViewBoundary name="Tabs">{moved.tabs}</ViewBoundary>)
  const isDebug = arrangement === 'debug'
  const hasGraph = arrangement !== '3d'
  const id = (part: string) => `${arrangement}-${part}`
  const page = useSplits(arrangement, 'page', ['upper', ...(isDebug ? ['lower'] : [])])
  const upper = useSplits(arrangement, 'upper', [...(hasGraph ? ['left'] : []), 'right'])
  const right = useSplits(arrangement, 'right', ['cell', ...(isDebug ? ['tabs'] : [])])
  return (
    <>
      {graph.source}
      {tabs.source}
      {!isDebug && arrangement !== 'operate' && <Placed host={tabs.host} isHidden />}
      {!hasGraph && <Placed host={graph.host} isHidden />}
      <Group orientation="vertical" style={{ flex: 1, minHeight: 0 }} data-work-space {...page}>
        <Pane key="upper" id={id('upper')} defaultSize={isDebug ? '62%' : '100%'} minSize="25%">
          <Group orientation="horizontal" {...upper}>
            {hasGraph && (
              <Pane key="left" id={id('left')} defaultSize={LEFT[arrangement]} minSize="20%">
                {arrangement === 'operate' ? <GraphAndTabs graph={graph.host} tabs={tabs.host} /> : <Placed host={graph.host} />}
              </Pane>
            )}
            {hasGraph && <Splitter key="width" label="Width of the graph" />}
            <Pane key="right" id={id('right')} defaultSize={hasGraph ? RIGHT[arrangement] : '100%'} minSize="22%">
              <Group orientation="vertical" {...right}>
                <Pane key="cell" id={id('cell')} defaultSize={isDebug ? '64%' : '100%'} minSize="15%">
                  <ViewBoundary name="Cell">{cell}</ViewBoundary>
                </Pane>
                {isDebug && <Splitter key="height" isFlat label="Height of the cell" />}
                {isDebug && (
                  <Pane key="tabs" id={id('tabs')} defaultSize="36%" minSize="15%">
                    <Placed host={tabs.host} />
                  </Pane>
                )}
              </Group>
            </Pane>
          </Group>
        </Pane>
        {isDebug && <Splitter key="height" isFlat label="Height of the graph" />}
        {isDebug && (
          <Pane key="lower" id={id('lower')} defaultSize="38%" minSize="12%">
            <CourseAndRecords course={course} records={records} />
          </Pane>
        )}
      </Group>
    </>
  )
}

const LEFT: Record<Exclude<Arrangement, '3d'>, string> = { operate: '40%', debug: '66%', approval: '26%' }
const RIGHT: Record<Exclude<Arrangement, '3d'>, string> = { operate: '60%', debug: '34%', approval: '74%' }

function GraphAndTabs({ graph, tabs }: { readonly graph: HTMLElement; readonly tabs: HTMLElement }) {
  return (
    <Group orientation="vertical" {...useSplits('operate', 'left', ['graph', 'tabs'])}>
      <Pane id="operate-graph" defaultSize="58%" minSize="20%">
        <Placed host={graph} />
      </Pane>
      <Splitter isFlat label="Height of the graph" />
      <Pane id="operate-tabs" defaultSize="42%" minSize="15%">
        <Placed host={tabs} />
      </Pane>
    </Group>
  )
}

function CourseAndRecords({ course, records }: Pick<WideProps, 'course' | 'records'>) {
  return (
    <Group orientation="horizontal" {...useSplits('debug', 'lower', ['course', 'records'])}>
      <Pane id="debug-course" defaultSize="56%" minSize="20%">
        <ViewBoundary name="Timeline">{course}</ViewBoundary>
      </Pane>
      <Splitter label="Width of the timeline" />
      <Pane id="debug-records" defaultSize="44%" minSize="20%">
        <ViewBoundary name="Log">{records}</ViewBoundary>
      </Pane>
    </Group>
  )
}

/** Splits that were dragged are kept, for each arrangement on its own. */
function useSplits(arrangement: Arrangement, group: string, parts: readonly string[]) {
  const panelIds = parts.map((part) => `${arrangement}-${part}`)
  const { defaultLayout, onLayoutChanged } = useDefaultLayout({
    id: `flexcell.splits.${arrangement}.${group}`,
    panelIds,
    storage: localStorage,
    onlySaveAfterUserInteractions: true,
  })
  return { defaultLayout, onLayoutChanged }
}

const TABS: Record<Tab, string> = {
  parameters: 'Start',
  node: 'Node',
  outline: 'Outline',
  holds: 'Breakpoints',
  problems: 'Problems',
  log: 'Log',
  failure: 'Failure',
}

interface SideTabsProps {
  readonly tab: Tab
  readonly onTab: (tab: Tab) => void
  readonly counts: Readonly<Partial<Record<Tab, number>>>
  /** What there is, in this order. */
  readonly bodies: Readonly<Partial<Record<Tab, ReactNode>>>
}

export function SideTabs({ tab, onTab, counts, bodies }: SideTabsProps) {
  const names = Object.keys(bodies) as Tab[]
  // Another layout may have had more of them.
  const shown = names.includes(tab) ? tab : (names[0] ?? tab)
  return (
    <Tabs value={shown} onChange={(value) => onTab((value ?? 'parameters') as Tab)} keepMounted>
      <Tabs.List>
        {names.map((name) => (
          <Tabs.Tab key={name} value={name}>
            {TABS[name]}
            {(counts[name] ?? 0) > 0 && <TabCount count={counts[name] ?? 0} />}
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

/** What a tab shows; flush where it has its own edges. */
export function TabBody({ children, isFlush = false }: { readonly children: ReactNode; readonly isFlush?: boolean }) {
  return (
    <Box h="100%" display={isFlush ? 'flex' : 'block'} p={isFlush ? 0 : 14} style={{ flexDirection: 'column', overflow: 'auto' }}>
      {children}
    </Box>
  )
}

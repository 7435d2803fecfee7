/** What can be seen of a run below its graph, each in a tab; all but the log are loaded when they are first opened. */
import { type ComponentType, type ReactNode } from 'react'
import type { BehaviorView, RunView, SessionBody } from '../api/types'
import { lazyView } from '../components/lazyView'
import type { FailurePage } from '../features/timeline/FailureActions'
import { EventLog } from '../features/log/EventLog'

export interface DockProps {
  readonly behavior: BehaviorView
  /** The run that is shown, if any. */
  readonly run: RunView | undefined
  /** Path of the selected node, if any. */
  readonly node: string | undefined
  readonly session: SessionBody | undefined
  /** Choose a node and bring it into view. */
  readonly onShow: (path: string) => void
  /** What the view of a failure can do here. */
  readonly page: FailurePage
}

interface DockTab {
  readonly name: TabName
  readonly Body: ComponentType<DockProps>
}

/** A tab of a module that is loaded when it is first opened. */
function later(name: TabName, load: () => Promise<ComponentType<DockProps>>): DockTab {
  return { name, Body: lazyView(load) }
}

type TabName = 'Log' | 'Timeline' | 'Failure' | 'Data' | 'Plots' | 'Bus'

const DOCK_TABS: readonly DockTab[] = [
  { name: 'Log', Body: () => <EventLog /> },
  later('Timeline', async () => (await import('./RunTimeline')).RunTimeline),
  later('Failure', async () => (await import('../features/timeline/FailureView')).FailureView),
  later('Data', async () => (await import('../features/data/Data')).Data),
  later('Plots', async () => (await import('./RunPlots')).RunPlots),
  later('Bus', async () => (await import('../features/bus/Bus')).Bus),
]

export interface DockBodies {
  readonly all: Record<string, ReactNode>
  /** The course of the run over time. */
  readonly course: Record<string, ReactNode>
  /** What it said, wrote and sent. */
  readonly records: Record<string, ReactNode>
}

/** The bodies of all tabs by their names. */
export function dockBodies(props: DockProps): DockBodies {
  const all = Object.fromEntries(DOCK_TABS.map(({ name, Body }) => [name, <Body key={name} {...props} />]))
  return { all, course: only(all, ['Timeline', 'Failure', 'Plots']), records: only(all, ['Log', 'Data', 'Bus']) }
}

/** Those that tell of the past, the most telling one first. */
export function pastBodies(props: DockProps, isFailed: boolean): DockBodies {
  const { all } = dockBodies(props)
  const course: readonly TabName[] = isFailed ? ['Failure', 'Timeline', 'Plots'] : ['Timeline', 'Plots']
  return { all: only(all, [...course, 'Log', 'Data']), course: only(all, course), records: only(all, ['Log', 'Data']) }
}

function only(bodies: Record<string, ReactNode>, names: readonly TabName[]): Record<string, ReactNode> {
  return Object.fromEntries(names.map((name) => [name, bodies[name]]))
}

/** What can be seen of a run below its graph, each in a tab; all but the log are loaded when they are first opened. */
import { type ComponentType, type ReactNode } from 'react'
import type { BehaviorView, RunView, SessionBody } from '../api/types'
import { lazyView } from '../components/lazyView'
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
}

interface DockTab {
  readonly name: string
  readonly Body: ComponentType<DockProps>
}

/** A tab of a module that is loaded when it is first opened. */
function later(name: string, load: () => Promise<ComponentType<DockProps>>): DockTab {
  return { name, Body: lazyView(load) }
}

const DOCK_TABS: readonly DockTab[] = [
  { name: 'Log', Body: () => <EventLog /> },
  later('Timeline', async () => (await import('../features/timeline/Timeline')).Timeline),
  later('Failure', async () => (await import('../features/timeline/FailureView')).FailureView),
  later('Data', async () => (await import('../features/data/Data')).Data),
  later('Plots', async () => (await import('./RunPlots')).RunPlots),
  later('Bus', async () => (await import('../features/bus/Bus')).Bus),
]

/** The bodies of all tabs by their names. */
export function dockBodies(props: DockProps): Record<string, ReactNode> {
  return Object.fromEntries(DOCK_TABS.map(({ name, Body }) => [name, <Body key={name} {...props} />]))
}

/** Those that tell of the past, the most telling one first. */
export function pastBodies(props: DockProps, isFailed: boolean): Record<string, ReactNode> {
  const bodies = dockBodies(props)
  const names = isFailed ? ['Failure', 'Timeline', 'Log', 'Data', 'Plots'] : ['Timeline', 'Log', 'Data', 'Plots']
  return Object.fromEntries(names.map((name) => [name, bodies[name]]))
}

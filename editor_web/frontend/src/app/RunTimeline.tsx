/** The timeline of a run, with the curves of its recording below the lanes. */
import { useMemo } from 'react'
import type { Subject } from '../api/timeline'
import type { SharedAxis } from '../document/timeline'
import { lazyView } from '../components/lazyView'
import { Timeline, type TimelineProps } from '../features/timeline/Timeline'

const LaneCurves = lazyView(async () => (await import('../features/plots/LaneCurves')).LaneCurves)

export function RunTimeline(props: Omit<TimelineProps, 'curves'>) {
  return <Timeline {...props} curves={below} />
}

function below({ address }: Subject, axis: SharedAxis) {
  return <Below address={address} axis={axis} />
}

function Below({ address, axis }: { readonly address: string; readonly axis: SharedAxis }) {
  const sources = useMemo(() => [{ address, label: '', startS: 0 }], [address])
  return <LaneCurves sources={sources} axis={axis} />
}

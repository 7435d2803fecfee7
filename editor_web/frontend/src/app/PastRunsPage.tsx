/** All runs of the journal, and beside them the recordings of the project. */
import { Panel } from '../components/Panel'
import { PastRuns } from '../features/past/PastRuns'
import { Recordings } from '../features/past/Recordings'
import { recordingHref, runHref } from './route'

export function PastRunsPage({ onOpen }: { onOpen: (href: string) => void }) {
  return (
    <div className="past-page">
      <h1 className="visually-hidden">Past runs</h1>
      <Panel title="Past runs">
        <PastRuns href={runHref} onOpen={(run) => onOpen(runHref(run))} />
      </Panel>
      <Panel title="Recordings">
        <Recordings href={recordingHref} onOpen={(path) => onOpen(recordingHref(path))} />
      </Panel>
    </div>
  )
}

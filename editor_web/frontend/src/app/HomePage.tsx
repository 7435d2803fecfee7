/** The page of the cell: the 3D view, and the runs as a table. */
import { Table } from '@mantine/core'
import { api } from '../api/client'
import { useLive } from '../api/live'
import { Empty } from '../components/Empty'
import { Panel } from '../components/Panel'
import { StatusBadge } from '../components/StatusBadge'
import { wallTime } from '../document/time'
import { CellFrame } from '../features/cell/CellFrame'
import { ShowMenu } from '../features/cell/ShowMenu'
import { BlockedWays } from '../features/robots/BlockedWays'
import { RobotStrip } from '../features/robots/RobotStrip'
import { StopCell } from '../features/robots/StopCell'
import { Interrupted } from '../features/runs/Interrupted'
import { nameOf, RunTime, waitsText } from '../features/runs/RunList'
import { runHref } from './route'
import { useFetched } from './useFetched'

export interface HomePageProps {
  readonly hasCellView: boolean
  readonly isUnknownRun: boolean
  readonly onOpenRun: (id: string) => void
}

export function HomePage({ hasCellView, isUnknownRun, onOpenRun }: HomePageProps) {
  const runs = useLive((s) => s.runs)
  const connection = useLive((s) => s.connection)
  const role = useLive((s) => s.role)
  // A resumed run is one more run of this server.
  const interrupted = useFetched('interrupted', api.interrupted, runs.length)
  return (
    <div className="home">
      <h1 className="visually-hidden">The cell</h1>
      {isUnknownRun && connection === 'live' && <p className="note">That run is not known to this server any more.</p>}
      <Panel title="Cell" className="home-cell" tools={<CellTools hasView={hasCellView} mayOperate={role === 'operator'} />} foot={<CellFoot />}>
        <CellFrame isServed={hasCellView} />
      </Panel>
      <Panel title="Latest runs" className="home-runs">
        {interrupted.value && interrupted.value.length > 0 && (
          <section aria-label="Interrupted runs" className="interrupted-area">
            <h3>Interrupted runs</h3>
            <Interrupted
              runs={interrupted.value}
              obstacle={role === 'operator' ? undefined : 'you may look only; log in with the operator token'}
              onResumed={onOpenRun}
            />
          </section>
        )}
        {runs.length === 0 ? (
          <Empty title="No runs yet">Choose a behavior on the left, set its parameters and start it.</Empty>
        ) : (
          <Table.ScrollContainer minWidth={420} scrollAreaProps={{ viewportProps: { tabIndex: 0, 'aria-label': 'Latest runs' } }}>
            <Table verticalSpacing={7} highlightOnHover>
              <Table.Thead>
                <Table.Tr>
                  <Table.Th>Behavior</Table.Th>
                  <Table.Th>Result</Table.Th>
                  <Table.Th>Started</Table.Th>
                  <Table.Th>Duration</Table.Th>
                </Table.Tr>
              </Table.Thead>
              <Table.Tbody>
                {runs.slice(0, 20).map((run) => (
                  <Table.Tr key={run.id}>
                    <Table.Td>
                      <a
                        href={runHref(run.id)}
                        className="link"
                        onClick={(event) => {
                          event.preventDefault()
                          onOpenRun(run.id)
                        }}
                      >
                        {nameOf(run.behavior)}
                      </a>
                      {run.waits && <div className="run-cause run-asks">{waitsText(run)}</div>}
                      {run.cause && <div className="quiet run-cause">{run.cause}</div>}
                    </Table.Td>
                    <Table.Td>
                      <StatusBadge status={run.status} outcome={run.outcome} success={run.success} />
                    </Table.Td>
                    <Table.Td>{wallTime(run.started_at_s)}</Table.Td>
                    <Table.Td>
                      <RunTime run={run} />
                    </Table.Td>
                  </Table.Tr>
                ))}
              </Table.Tbody>
            </Table>
          </Table.ScrollContainer>
        )}
      </Panel>
    </div>
  )
}

function CellTools({ hasView, mayOperate }: { hasView: boolean; mayOperate: boolean }) {
  return (
    <>
      <span className="spacer" />
      {hasView && <ShowMenu />}
      {mayOperate && <StopCell />}
    </>
  )
}

function CellFoot() {
  return (
    <>
      <BlockedWays />
      <RobotStrip />
    </>
  )
}

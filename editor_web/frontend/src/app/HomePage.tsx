/** The page of the cell: the 3D view, and the runs as a table. */
import { Anchor, Box, Table, Text, VisuallyHidden } from '@mantine/core'
import { useLive } from '../api/live'
import { useTour } from '../api/tour'
import { Empty } from '../components/Empty'
import { lazyView } from '../components/lazyView'
import { Loading } from '../components/Loading'
import { PageLink } from '../components/PageLink'
import { Panel } from '../components/Panel'
import { RunBadge } from '../components/StatusBadge'
import { TourButton } from '../components/TourButton'
import { startTime } from '../document/time'
import { CellFrame } from '../features/cell/CellFrame'
import { BlockedPaths } from '../features/robots/BlockedPaths'
import { RobotStrip } from '../features/robots/RobotStrip'
import { RunTime } from '../components/RunTime'
import { nameOf } from '../features/runs/RunList'
import { TourInvitation } from '../features/tour/TourInvitation'
import { InterruptedHere } from './InterruptedHere'
import classes from './pages.module.css'
import { runHref } from './route'

const CellMenus = lazyView(async () => (await import('./CellMenus')).CellMenus)

export interface HomePageProps {
  readonly hasCellView: boolean
  readonly onOpenRun: (id: string) => void
}

export function HomePage({ hasCellView, onOpenRun }: HomePageProps) {
  const runs = useLive((s) => s.runs)
  const role = useLive((s) => s.role)
  return (
    <Box className={classes.pair ?? ''} data-halves __vars={{ '--widths': 'minmax(0, 3fr) minmax(340px, 2fr)' }}>
      <VisuallyHidden component="h1">The cell</VisuallyHidden>
      <Panel title="Cell" hasIcons tools={<CellTools hasView={hasCellView} mayOperate={role === 'operator'} />} foot={<CellFoot />}>
        <CellFrame />
      </Panel>
      <Panel title="Latest runs" tools={<RunTools mayOperate={role === 'operator'} />}>
        {role === 'operator' && <TourInvitation />}
        <InterruptedHere onResumed={onOpenRun}>
          {runs.length === 0 ? (
            role !== '' && <Empty title="No runs yet">Choose a behavior in the menu, set its parameters and start it.</Empty>
          ) : (
            <Box style={{ overflowX: 'auto' }} role="region" tabIndex={0} aria-label="Table of the latest runs">
              <Table verticalSpacing={7} highlightOnHover miw={420}>
                <Table.Thead>
                  <Table.Tr>
                    <Table.Th>Behavior</Table.Th>
                    <Table.Th w={110}>State</Table.Th>
                    <Table.Th>Started</Table.Th>
                    <Table.Th>Duration</Table.Th>
                  </Table.Tr>
                </Table.Thead>
                <Table.Tbody>
                  {runs.slice(0, 20).map((run) => (
                    <Table.Tr key={run.id}>
                      <Table.Td>
                        <PageLink href={runHref(run.id)} onOpen={() => onOpenRun(run.id)}>
                          {nameOf(run.behavior)}
                        </PageLink>
                        {run.cause && (
                          <Text fz="0.78rem" maw="40ch" c="var(--quiet)">
                            {run.cause}
                          </Text>
                        )}
                      </Table.Td>
                      <Table.Td>
                        <RunBadge run={run} />
                      </Table.Td>
                      <Table.Td>{startTime(run, runs)}</Table.Td>
                      <Table.Td>
                        <RunTime run={run} />
                      </Table.Td>
                    </Table.Tr>
                  ))}
                </Table.Tbody>
              </Table>
            </Box>
          )}
        </InterruptedHere>
      </Panel>
    </Box>
  )
}

function CellTools({ hasView, mayOperate }: { hasView: boolean; mayOperate: boolean }) {
  return (
    <>
      <Box flex={1} />
      {hasView && (
        <Loading name="Menus of the cell">
          <CellMenus mayOperate={mayOperate} />
        </Loading>
      )}
    </>
  )
}

function RunTools({ mayOperate }: { mayOperate: boolean }) {
  const isSettled = useTour((s) => s.isSettled)
  return (
    <>
      <Box flex={1} />
      <Anchor size="sm" href="/THIRD-PARTY-NOTICES.txt" target="_blank" rel="noreferrer">
        Licences
      </Anchor>
      {mayOperate && isSettled && <TourButton />}
    </>
  )
}

function CellFoot() {
  return (
    <>
      {/* They lie over the view above: it keeps its height, and the arms their place. */}
      <Box pos="relative" flex="none">
        <Box pos="absolute" bottom="100%" left={0} right={0} bg="var(--surface)" style={{ zIndex: 1 }}>
          <BlockedPaths />
        </Box>
      </Box>
      <RobotStrip />
    </>
  )
}

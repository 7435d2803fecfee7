/** Two past runs compared: aligned visits, the first divergence, and what differs of one visit or of the whole. */
import { ActionIcon, SimpleGrid, Stack, Tabs, Tooltip } from '@mantine/core'
import { IconArrowsExchange } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { Group, Panel as Pane } from 'react-resizable-panels'
import { comparisonQueries } from '../api/comparison'
import { useAnswer } from '../api/queryClient'
import type { RunComparison } from '../api/types'
import { Empty } from '../components/Empty'
import { PageHead } from '../components/PageHead'
import { PageLink } from '../components/PageLink'
import { Splitter } from '../components/Splitter'
import { TabCount } from '../components/TabCount'
import { WhileLoading, lazyView } from '../components/lazyView'
import { ViewBoundary } from '../components/ViewBoundary'
import { dataOf, durationOf, indexAt, placeOf, type Side } from '../document/comparison'
import { ComparedRun } from '../features/comparison/ComparedRun'
import { FirstDivergence } from '../features/comparison/FirstDivergence'
import { NodeDurations } from '../features/comparison/NodeDurations'
import { Settings } from '../features/comparison/Settings'
import { VisitDetails } from '../features/comparison/VisitDetails'
import { VisitTable } from '../features/comparison/VisitTable'
import { compareHref, LAST_GOOD, PAST_HREF, recordedHref, replaceWith } from './route'

const ComparedCell = lazyView(async () => (await import('./ComparedCell')).ComparedCell)
const ComparedCurves = lazyView(async () => (await import('./ComparedCurves')).ComparedCurves)

/** A visit of no length still has something to see around it. */
const SHORTEST_S = 0.5

export interface ComparePageProps {
  /** Ids of runs, or paths of recordings; the left one may be the last good run. */
  readonly left: string
  readonly right: string
  readonly isNarrow: boolean
  readonly onOpen: (href: string) => void
}

export function ComparePage(props: ComparePageProps) {
  const { left, right, onOpen } = props
  const { value, problem } = useAnswer(comparisonQueries.compare(left === LAST_GOOD ? '' : left, right))
  const good = left === LAST_GOOD ? value?.left.id : undefined
  useEffect(() => {
    // The last good run is another one tomorrow: the address names the one that is shown.
    if (good !== undefined) replaceWith(compareHref(good, right))
  }, [good, right])
  if (problem) {
    return (
      <Empty title="These runs cannot be compared">
        {problem}
        <br />
        <PageLink href={PAST_HREF} onOpen={() => onOpen(PAST_HREF)}>
          All past runs
        </PageLink>
      </Empty>
    )
  }
  if (!value || left === LAST_GOOD) return <div role="status" aria-label="Loading" />
  return <Compared key={`${left} ${right}`} {...props} found={value} />
}

function Compared({ left, right, isNarrow, onOpen, found }: ComparePageProps & { readonly found: RunComparison }) {
  const [selected, setSelected] = useState<number | undefined>(() => indexAt(found.visits, placeOfAddress()) ?? found.divergence?.index)
  const visit = selected === undefined ? undefined : found.visits[selected]
  const place = visit && placeOf(visit)
  const [cursorS, setCursor] = useState<number>()

  useEffect(() => {
    history.replaceState(null, '', compareHref(left, right, place))
  }, [left, right, place])
  useEffect(() => {
    const listen = () => setSelected(indexAt(found.visits, placeOfAddress()))
    addEventListener('hashchange', listen)
    return () => removeEventListener('hashchange', listen)
  }, [found])

  const hrefAt = (side: Side, timeS?: number, path?: string) => recordedHref(side === 'left' ? left : right, timeS, path)
  const swapped = compareHref(right, left)
  const lengths = visit ? [durationOf(visit.left), durationOf(visit.right)] : [found.left.duration_s, found.right.duration_s]
  const durationS = Math.max(SHORTEST_S, ...lengths.map((length) => length ?? 0))
  // Curves and 3D view show the same moment.
  const aligned = {
    left,
    right,
    visit,
    durationS,
    cursorS: cursorS === undefined ? undefined : Math.min(cursorS, durationS),
    onGo: setCursor,
  }
  const table = <VisitTable visits={found.visits} icons={found.icons} leftOut={found.left_out} selected={selected} onSelect={setSelected} />
  const details = (
    <Tabs defaultValue="visit" keepMounted={false}>
      <Tabs.List>
        <Tabs.Tab value="visit">Visit</Tabs.Tab>
        <Tabs.Tab value="durations">Durations</Tabs.Tab>
        <Tabs.Tab value="settings">
          Settings{' '}
          {found.settings.length + found.documents.length > 0 && <TabCount count={found.settings.length + found.documents.length} />}
        </Tabs.Tab>
        <Tabs.Tab value="curves">Curves</Tabs.Tab>
        <Tabs.Tab value="cell">3D</Tabs.Tab>
      </Tabs.List>
      <Tabs.Panel value="visit">
        {visit && selected !== undefined ? (
          <VisitDetails visit={visit} data={dataOf(found.data, selected)} href={hrefAt} onOpen={onOpen} />
        ) : (
          <Empty title="No visit is selected">Select one in the table.</Empty>
        )}
      </Tabs.Panel>
      <Tabs.Panel value="durations">
        <NodeDurations nodes={found.nodes} />
      </Tabs.Panel>
      <Tabs.Panel value="settings">
        <Settings settings={found.settings} documents={found.documents} />
      </Tabs.Panel>
      <Tabs.Panel value="curves">
        <WhileLoading value={null}>
          <ComparedCurves {...aligned} />
        </WhileLoading>
      </Tabs.Panel>
      <Tabs.Panel value="cell">
        <WhileLoading value={null}>
          <ComparedCell {...aligned} />
        </WhileLoading>
      </Tabs.Panel>
    </Tabs>
  )
  return (
    <Stack gap={0} flex={1} mih={0}>
      <PageHead title="Compare runs">
        <Tooltip label="Swap left and right">
          <ActionIcon variant="subtle" color="gray" aria-label="Swap left and right" onClick={() => onOpen(swapped)}>
            <IconArrowsExchange size={18} />
          </ActionIcon>
        </Tooltip>
      </PageHead>
      <SimpleGrid cols={2} spacing={1} bg="var(--line)" style={{ borderBottom: '1px solid var(--line)' }}>
        <ComparedRun side="left" run={found.left} href={hrefAt('left')} onOpen={() => onOpen(hrefAt('left'))} />
        <ComparedRun side="right" run={found.right} href={hrefAt('right')} onOpen={() => onOpen(hrefAt('right'))} />
      </SimpleGrid>
      <FirstDivergence divergence={found.divergence} onShow={() => setSelected(found.divergence?.index)} />
      <Group orientation={isNarrow ? 'vertical' : 'horizontal'} style={{ flex: 1, minHeight: 0 }}>
        <Pane id="visits" defaultSize="58%" minSize="25%">
          <ViewBoundary name="Visits">{table}</ViewBoundary>
        </Pane>
        <Splitter isFlat={isNarrow} label="Size of the table of visits" />
        <Pane id="details" defaultSize="42%" minSize="25%">
          <ViewBoundary name="Details">{details}</ViewBoundary>
        </Pane>
      </Group>
    </Stack>
  )
}

/** The visit in the address, `#root/grasp@2`. */
function placeOfAddress(): string {
  try {
    return decodeURIComponent(location.hash.slice(1))
  } catch {
    return ''
  }
}

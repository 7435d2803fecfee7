/** A sweep: how far it is, what it has shown, its runs. The run that is chosen stands in the address. */
import { Box, Code, SimpleGrid, Text } from '@mantine/core'
import { useEffect, useState } from 'react'
import { useLive } from '../api/live'
import { useAnswer, useOutdated } from '../api/queryClient'
import { queryKeys } from '../api/queryKeys'
import { sweepQueries } from '../api/sweeps'
import type { SearchView, SweepRuns, SweepView } from '../api/types'
import { Empty } from '../components/Empty'
import { PageHead } from '../components/PageHead'
import { PageLink } from '../components/PageLink'
import { lookup } from '../document/dict'
import { designText, isSearch } from '../document/searches'
import { currentLive, sweepName } from '../document/sweeps'
import { FailureCount } from '../features/sweeps/FailureCount'
import { SearchReport } from '../features/sweeps/SearchReport'
import { SuccessRate, SweepControls, SweepProgress } from '../features/sweeps/SweepControls'
import { SweepReport } from '../features/sweeps/SweepReport'
import { VerdictBadge } from '../features/sweeps/VerdictBadge'
import { behaviorHref, recordingHref, sweepHref, SWEEPS_HREF } from './route'

/** Results are read again that often while the sweep is executed. */
const PERIOD_MS = 2000

export interface SweepPageProps {
  readonly id: string
  readonly onOpen: (href: string) => void
}

export function SweepPage({ id, onOpen }: SweepPageProps) {
  const reported = useLive((s) => lookup(s.sweeps, id))
  const revision = useSlowly(`${reported?.status} ${reported?.done}`, reported === undefined || reported.status === 'idle')
  useOutdated(queryKeys.sweep(id), revision)
  const { value, problem } = useAnswer(sweepQueries.one(id))
  if (problem) {
    return (
      <Empty title="This sweep cannot be read">
        {problem}
        <br />
        <PageLink href={SWEEPS_HREF} onOpen={() => onOpen(SWEEPS_HREF)}>
          All sweeps
        </PageLink>
      </Empty>
    )
  }
  if (!value) return <div role="status" aria-label="Loading" />
  return <Opened view={value.view} runs={value.runs} onOpen={onOpen} />
}

interface Shown {
  readonly view: SweepView | SearchView
  readonly runs: SweepRuns
}

function Opened({ view, runs, onOpen }: Shown & { readonly onOpen: (href: string) => void }) {
  const { line } = view
  const [selected, setSelected] = useState<number | undefined>(ofAddress)
  const live = currentLive(
    line,
    useLive((s) => lookup(s.sweeps, line.id)),
  )
  const mayOperate = useLive((s) => s.role) === 'operator'
  const broken = runs.runs.filter((run) => run.status === 'crashed' || run.status === 'hung').length

  useEffect(() => {
    const listen = () => setSelected(ofAddress())
    addEventListener('hashchange', listen)
    return () => removeEventListener('hashchange', listen)
  }, [])

  function select(run: number | undefined): void {
    history.replaceState(null, '', sweepHref(line.id, run))
    setSelected(run)
  }

  const of = {
    mayOperate,
    selected,
    onSelect: select,
    onOpenRecording: (path: string) => onOpen(recordingHref(path)),
    onOpenSweep: (other: string) => onOpen(sweepHref(other)),
  }
  return (
    <Box flex={1} mih={0} style={{ overflow: 'auto' }}>
      <PageHead
        isSticky
        title={sweepName(line.id)}
        words={
          <>
            <PageLink href={SWEEPS_HREF} onOpen={() => onOpen(SWEEPS_HREF)}>
              All sweeps
            </PageLink>{' '}
            / of{' '}
            <PageLink href={behaviorHref(line.behavior)} onOpen={() => onOpen(behaviorHref(line.behavior))}>
              {line.behavior}
            </PageLink>
            , {designText(line)}, <Code>{line.id}</Code>
          </>
        }
        state={<VerdictBadge live={live} require={line.require} />}
      >
        <SweepControls sweep={line.id} live={live} mayOperate={mayOperate} broken={broken} />
      </PageHead>
      <SimpleGrid cols={{ base: 1, md: 2 }} spacing="xs" px="md" pt="sm" style={{ alignItems: 'center' }}>
        {live.search ? <FailureCount search={live.search} towards={line.towards} /> : <SuccessRate live={live} />}
        <SweepProgress live={live} />
      </SimpleGrid>
      {line.description && (
        <Text px="md" fz="0.84rem" c="dimmed">
          {line.description}
        </Text>
      )}
      {isSearch(view) ? <SearchReport view={view} runs={runs} {...of} /> : <SweepReport view={view} runs={runs} {...of} />}
    </Box>
  )
}

/** The run in the address, `#17`. */
function ofAddress(): number | undefined {
  return /^#\d+$/.test(location.hash) ? Number(location.hash.slice(1)) : undefined
}

/** A value that changes at most once in a period; at once where nothing goes on. */
function useSlowly(value: string, isNow: boolean): string {
  const [shown, setShown] = useState(value)
  useEffect(() => {
    if (value === shown) return
    const timer = setTimeout(() => setShown(value), isNow ? 0 : PERIOD_MS)
    return () => clearTimeout(timer)
  }, [value, shown, isNow])
  return shown
}

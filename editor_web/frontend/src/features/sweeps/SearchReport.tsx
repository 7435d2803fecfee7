/** What a search for failures has found, as cards: how near, how likely, where, and its runs. It has no success rate. */
import { Box, Group, SimpleGrid, Stack, Table, Text } from '@mantine/core'
import { useMemo } from 'react'
import type { BatchTrace, SearchView, SweepRuns } from '../../api/types'
import { percent, short } from '../../document/sweeps'
import { FailureClusters } from './FailureClusters'
import { IntervalBar } from './IntervalBar'
import { NearestRuns } from './NearestRuns'
import { RunsCard, type RunsOf } from './RunsCard'
import { RunScatter } from './RunScatter'
import { SearchFigure } from './SearchFigure'
import { SweepCard } from './SweepCard'
import { useRunsOfCause } from './useRunsOfCause'
import { Note } from './Note'
import { ResultTable } from './ResultTable'

export interface SearchReportProps extends Omit<RunsOf, 'sweep' | 'subject'> {
  readonly view: SearchView
  readonly runs: SweepRuns
}

export function SearchReport({ view, runs, ...of }: SearchReportProps) {
  const { cause, shown, factors, choose } = useRunsOfCause(runs)
  // Drawn over those that tell most of the most frequent cause.
  const ordered = useMemo(
    () => [...new Set([...(view.clusters[0]?.regions ?? []).map((region) => region.address), ...factors])],
    [view, factors],
  )
  if (view.done === 0) return null
  return (
    <SimpleGrid cols={{ base: 1, md: 2 }} spacing="sm" px={{ base: 'xs', md: 'md' }} pt="xs" pb="xl" style={{ alignItems: 'start' }}>
      <Stack gap="sm">
        <SweepCard title="How near to failure">
          <SearchFigure figure={view.figure} selected={of.selected} onSelect={of.onSelect} />
          <Note isQuiet>{view.method}</Note>
        </SweepCard>
        <SweepCard title="Runs over two factors">
          <RunScatter runs={shown} factors={ordered} selected={of.selected} onSelect={of.onSelect} />
        </SweepCard>
        {view.nearest.length > 0 && (
          <SweepCard title={view.target.guides ? 'Nearest successes' : 'Successes that took longest'}>
            <NearestRuns view={view} onSelect={of.onSelect} />
          </SweepCard>
        )}
      </Stack>
      <Stack gap="sm">
        <SweepCard title="How likely a failure is">
          {view.probability && (
            <Group gap="sm" mb="4xs" wrap="nowrap">
              <Text component="strong" fz="1.35rem" fw={660}>
                {percent(view.probability.estimate)}
              </Text>
              <Box flex={1}>
                <IntervalBar interval={view.probability.interval} rate={view.probability.estimate} isBad />
              </Box>
            </Group>
          )}
          <Note>{view.likelihood}</Note>
        </SweepCard>
        {view.clusters.length > 0 && (
          <SweepCard title="Where it fails">
            <FailureClusters clusters={view.clusters} chosen={cause} onChoose={choose} />
          </SweepCard>
        )}
        <SweepCard title="Batches">
          <Batches view={view} />
        </SweepCard>
      </Stack>
      <RunsCard
        {...of}
        sweep={view.line.id}
        subject={view.subject}
        runs={runs}
        shown={shown}
        factors={factors}
        cause={cause}
        onShowAll={() => choose(undefined)}
      />
    </SimpleGrid>
  )
}

function Batches({ view }: { readonly view: SearchView }) {
  return (
    <ResultTable label="Table of batches">
      <Table.Thead>
        <Table.Tr>
          {['Batch', 'Runs', 'Failures', 'Refused', view.towards].map((name) => (
            <Table.Th key={name} scope="col" ta="right">
              {name}
            </Table.Th>
          ))}
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {view.batches.map((each) => (
          <Batch key={each.batch} batch={each} />
        ))}
      </Table.Tbody>
    </ResultTable>
  )
}

function Batch({ batch }: { readonly batch: BatchTrace }) {
  return (
    <Table.Tr>
      <Table.Th scope="row" ta="right">
        {batch.batch}
      </Table.Th>
      {[batch.runs, batch.failures, batch.refused].map((count, at) => (
        <Table.Td key={at} ta="right">
          {count}
        </Table.Td>
      ))}
      <Table.Td ta="right">{batch.nearest === null ? '–' : short(batch.nearest)}</Table.Td>
    </Table.Tr>
  )
}

/** Sweeps: lists, results, and their execution; and what was told of runs that were executed again. */
import { queryOptions } from '@tanstack/react-query'
import type { Dict } from '../document/dict'
import { addressOf } from '../document/path'
import { call, post } from './client'
import { queryKeys } from './queryKeys'
import type {
  Baseline,
  FactorChoice,
  NewSweepBody,
  RecordedTrial,
  SearchView,
  ShrinkBody,
  Shrinking,
  SweepComparison,
  SweepIdBody,
  SweepList,
  SweepRuns,
  SweepView,
  TrialResult,
} from './types'
import { pageStore } from './pageStore'

export const sweepsApi = {
  list: () => call<SweepList>('/sweeps'),
  view: (id: string) => call<SweepView | SearchView>(`/sweeps/${addressOf(id)}`),
  runs: (id: string) => call<SweepRuns>(`/sweeps/${addressOf(id)}/runs`),
  run: (id: string, number: number) => call<TrialResult>(`/sweeps/${addressOf(id)}/runs/${number}`),
  factors: (behavior: string) => call<readonly FactorChoice[]>(`/sweep-factors?behavior=${encodeURIComponent(behavior)}`),
  create: (body: NewSweepBody) => post<SweepIdBody>('/sweeps', body),
  start: (id: string, again = false) => post<void>(`/sweeps/${addressOf(id)}/start`, { again }),
  stop: (id: string) => post<void>(`/sweeps/${addressOf(id)}/stop`, {}),
  record: (id: string, number: number) => post<RecordedTrial>(`/sweeps/${addressOf(id)}/runs/${number}/recording`, {}),
  shrinking: (id: string, number: number) => call<Shrinking>(shrinkingPath(id, number)),
  shrink: (id: string, number: number, body: ShrinkBody) => post<void>(shrinkingPath(id, number), body),
  stopShrinking: (id: string, number: number) => post<void>(`${shrinkingPath(id, number)}/stop`, {}),
  saveCase: (id: string, number: number, file: string) => post<SweepIdBody>(`${shrinkingPath(id, number)}/case`, { id: file }),
  baselines: (id: string) => call<readonly Baseline[]>(`/sweeps/${addressOf(id)}/baselines`),
  comparison: (id: string, { results, version }: Baseline, margin: number | undefined) =>
    call<SweepComparison>(`/sweeps/${addressOf(id)}/comparison?${comparisonQuery(results, version.version, margin)}`),
}

/** A running one is looked at again that often. */
const SHRINKING_PERIOD_MS = 1000

export const sweepQueries = {
  list: () => queryOptions({ queryKey: queryKeys.sweeps, queryFn: sweepsApi.list }),
  /** With its runs. */
  one: (id: string) =>
    queryOptions({
      queryKey: queryKeys.sweep(id),
      queryFn: async () => {
        const [view, runs] = await Promise.all([sweepsApi.view(id), sweepsApi.runs(id)])
        return { view, runs }
      },
    }),
  run: (id: string, number: number) => queryOptions({ queryKey: queryKeys.sweepRun(id, number), queryFn: () => sweepsApi.run(id, number) }),
  shrinking: (id: string, number: number) =>
    queryOptions({
      queryKey: queryKeys.shrinking(id, number),
      queryFn: () => sweepsApi.shrinking(id, number),
      refetchInterval: ({ state }) => (state.data && state.data.status !== 'idle' ? SHRINKING_PERIOD_MS : false),
    }),
  factors: (behavior: string) => queryOptions({ queryKey: queryKeys.factors(behavior), queryFn: () => sweepsApi.factors(behavior) }),
}

function shrinkingPath(id: string, number: number): string {
  return `/sweeps/${addressOf(id)}/runs/${number}/shrinking`
}

function comparisonQuery(results: string, version: string, margin: number | undefined): string {
  return String(new URLSearchParams({ results, version, ...(margin !== undefined && { margin: String(margin) }) }))
}

/** A run of a sweep that was executed again, with what came of it. */
export interface Rerun {
  readonly sweep: string
  readonly rerun: RecordedTrial
}

/** By the path of their recordings, as long as the page lives. */
export const useReruns = pageStore<{ readonly byRecording: Dict<Rerun> }>(() => ({ byRecording: {} }))

/** Execute a run again, and keep what came of it for the page of its recording. */
export async function recordRun(sweep: string, number: number): Promise<RecordedTrial> {
  const rerun = await sweepsApi.record(sweep, number)
  useReruns.setState(({ byRecording }) => ({ byRecording: { ...byRecording, [rerun.recording]: { sweep, rerun } } }))
  return rerun
}

/** Comparing two past runs, and the trend of a behavior. */
import { queryOptions } from '@tanstack/react-query'
import { call } from './client'
import { queryKeys } from './queryKeys'
import type { PastRun, RunComparison, RunTrend } from './types'

export const comparisonApi = {
  /** Runs by id, recordings by path; without a left one, the last good run before the right one. */
  compare: (left: string, right: string) => call<RunComparison>(`/past-runs/comparison?${String(new URLSearchParams({ left, right }))}`),
  trend: (behavior: string, last: number) =>
    call<RunTrend>(`/past-runs/trend?${String(new URLSearchParams({ behavior, last: String(last) }))}`),
}

export const comparisonQueries = {
  /** Without a left one it is another answer tomorrow, which is not taken from what was answered before. */
  compare: (left: string, right: string) =>
    queryOptions({
      queryKey: queryKeys.comparison(left, right),
      queryFn: () => comparisonApi.compare(left, right),
      ...(left === '' && { gcTime: 0 }),
    }),
  trend: (behavior: string, last: number) =>
    queryOptions({ queryKey: queryKeys.trend(behavior, last), queryFn: () => comparisonApi.trend(behavior, last) }),
  /** Null where no earlier run succeeded. */
  againstLastGood: (run: string) => queryOptions({ queryKey: queryKeys.lastGood(run), queryFn: () => againstLastGood(run) }),
}

async function againstLastGood(run: string): Promise<RunComparison | null> {
  const good = await call<PastRun | null>(`/runs/${encodeURIComponent(run)}/last-good-run`)
  return good && comparisonApi.compare(good.id, run)
}

/** Comparing two past runs, and the trend of a behavior. */
import { call } from './client'
import type { RunComparison, RunTrend } from './types'

export const comparisonApi = {
  /** Runs by id, recordings by path; without a left one, the last good run before the right one. */
  compare: (left: string, right: string) => call<RunComparison>(`/past-runs/comparison?${String(new URLSearchParams({ left, right }))}`),
  trend: (behavior: string, last: number) =>
    call<RunTrend>(`/past-runs/trend?${String(new URLSearchParams({ behavior, last: String(last) }))}`),
}

/** Sweeps: lists, results, and their execution; and what was told of runs that were executed again. */
import { create } from 'zustand'
import type { Dict } from '../document/dict'
import { call, idPath, post } from './client'
import type { FactorChoice, NewSweepBody, RecordedTrial, SweepIdBody, SweepList, SweepRuns, SweepView, TrialResult } from './types'

export const sweepsApi = {
  list: () => call<SweepList>('/sweeps'),
  view: (id: string) => call<SweepView>(`/sweeps/${idPath(id)}`),
  runs: (id: string) => call<SweepRuns>(`/sweeps/${idPath(id)}/runs`),
  run: (id: string, number: number) => call<TrialResult>(`/sweeps/${idPath(id)}/runs/${number}`),
  factors: (behavior: string) => call<readonly FactorChoice[]>(`/sweep-factors?behavior=${encodeURIComponent(behavior)}`),
  create: (body: NewSweepBody) => post<SweepIdBody>('/sweeps', body),
  start: (id: string, again = false) => post<void>(`/sweeps/${idPath(id)}/start`, { again }),
  stop: (id: string) => post<void>(`/sweeps/${idPath(id)}/stop`, {}),
  record: (id: string, number: number) => post<RecordedTrial>(`/sweeps/${idPath(id)}/runs/${number}/recording`, {}),
}

/** A run of a sweep that was executed again, with what came of it. */
export interface Rerun {
  readonly sweep: string
  readonly told: RecordedTrial
}

/** By the path of their recordings, as long as the page lives. */
export const useReruns = create<{ readonly byRecording: Dict<Rerun> }>(() => ({ byRecording: {} }))

/** Execute a run again, and keep what came of it for the page of its recording. */
export async function recordRun(sweep: string, number: number): Promise<RecordedTrial> {
  const told = await sweepsApi.record(sweep, number)
  useReruns.setState(({ byRecording }) => ({ byRecording: { ...byRecording, [told.recording]: { sweep, told } } }))
  return told
}

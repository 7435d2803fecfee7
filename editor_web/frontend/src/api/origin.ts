/** What a run was started with, from the first of its events. */
import { call } from './client'
import type { EventsBody, RunStarted } from './types'

/** `inputs` is the userdata that it began with in the place of what its document says. */
export type Origin = Pick<RunStarted, 'parameters' | 'seed' | 'inputs'>

/** Fails where the run is not in the journal. */
export async function originOf(run: string): Promise<Origin> {
  const { events } = await call<EventsBody>(`/runs/${encodeURIComponent(run)}/events?limit=1`)
  const started = events[0]
  if (started?.event !== 'run_started') throw new Error('this run does not tell what it was started with')
  return { parameters: started.parameters, seed: started.seed, inputs: started.inputs }
}

/** What a run was started with, from the first of its events. */
import type { Dict } from '../document/dict'
import { call } from './client'
import type { EventsBody } from './types'

export interface Origin {
  readonly parameters: Dict<unknown>
  readonly seed: number
  /** Userdata that it began with in the place of what its document says. */
  readonly inputs: Dict<unknown>
}

/** Fails where the run is not in the journal. */
export async function originOf(run: string): Promise<Origin> {
  const { events } = await call<EventsBody>(`/runs/${encodeURIComponent(run)}/events?limit=1`)
  const started = events[0] as Partial<Origin> | undefined
  if (started?.parameters === undefined || started.seed === undefined) throw new Error('this run does not tell what it was started with')
  return { parameters: started.parameters, seed: started.seed, inputs: started.inputs ?? {} }
}

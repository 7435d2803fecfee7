/** Starting a run at a node, or pausing it before one: asked for on any page, answered on that of the behavior. */
import { completed } from '../document/breakpoints'
import { api } from './client'
import { useLive } from './live'
import { send } from './refusal'
import { pageStore } from './pageStore'

export interface StartHere {
  readonly behavior: string
  readonly path: string
  readonly kind: 'from' | 'to'
}

export const useStartHere = pageStore<{ readonly asked: StartHere | undefined }>(() => ({ asked: undefined }))

export function askStartHere(asked: StartHere | undefined): void {
  useStartHere.setState({ asked })
}

/** Let the active run go on, and pause it once before a node. */
export async function goOnTo(path: string): Promise<boolean> {
  const { run, control } = useLive.getState()
  if (!control) return false
  const once = completed({ path, once: true })
  const done = await send('Run to here', async () => {
    await api.breakpoints(run, { breakpoints: [...control.breakpoints.map(completed), once] })
    return control.paused ? api.resume(run) : control
  })
  return done !== undefined
}

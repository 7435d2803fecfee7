/** The steps after a stop of the cell; what they did is read again at once, also where the live stream is down. */
import { call, post } from './client'
import { takeStop } from './live'
import type { CellStop } from './types'

const PERIOD_MS = 1000

/** Ask what the latest stop is; a server that does not answer changes nothing. */
export async function loadStop(): Promise<void> {
  takeStop(await call<CellStop | null>('/cell/stop'))
}

/** Ask again and again, for as long as the live stream does not tell; returns how to end it. */
export function pollStop(): () => void {
  // Whoever does not answer is asked again.
  const timer = setInterval(() => void loadStop().catch(() => undefined), PERIOD_MS)
  return () => clearInterval(timer)
}

async function step(path: string, body: unknown = {}, signal?: AbortSignal): Promise<void> {
  try {
    await post<void>(`/cell/stop/${path}`, body, {}, signal)
  } finally {
    await loadStop().catch(() => undefined)
  }
}

function ofArm(arm: string, name: string): string {
  return `arms/${encodeURIComponent(arm)}/${name}`
}

export const recovery = {
  keep: (arm: string) => step(ofArm(arm, 'keep')),
  releasePart: (arm: string) => step(ofArm(arm, 'release_part')),
  /** Ends when the arm rests, also when it is aborted. */
  goHome: (arm: string, signal: AbortSignal) => step(ofArm(arm, 'home'), {}, signal),
  resetParts: () => step('reset_parts'),
  release: (stop: number) => step('release', { stop }),
  close: () => step('close'),
}

/** What an arm does, in words and with its look: the same wherever an arm is shown. Pure. */
import type { RobotLive } from '../api/types'
import type { Status } from './runState'

const LOOKS: Readonly<Record<string, Status>> = {
  moving: 'active',
  jogging: 'active',
  guiding: 'active',
  direct: 'warning',
  reflex: 'failed',
  fault: 'failed',
  disconnected: 'stopped',
}
// A goal that is held is still carried out: `moving` would be wrong of an arm that a paused run keeps at rest.
const WORDS: Readonly<Record<string, string>> = {
  moving: 'carries out',
  reflex: 'stopped by a reflex',
  guiding: 'led by hand',
  direct: 'under direct control',
}

export function robotLook(mode: string): Status {
  return LOOKS[mode] ?? 'idle'
}

/** The mode of an arm; its activity follows. */
export function modeWords({ mode, activity }: Pick<RobotLive, 'mode' | 'activity'>): string {
  return (mode !== 'moving' || activity) && WORDS[mode] ? WORDS[mode] : mode
}

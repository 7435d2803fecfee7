/** The way back after a stop of the cell, as steps with their states, from what the server tells of the stop. Pure. */
import type { ArmRecovery, CellStop, StoppedDevice } from '../api/types'

export type StepId = 'rest' | 'enable' | 'parts' | 'jog' | 'home' | 'reset' | 'release' | 'runs'
/** `problem` is a step that has failed or misses something; `none` one that is not needed. */
export type StepState = 'done' | 'open' | 'problem' | 'none'

export interface RecoveryStep {
  readonly id: StepId
  readonly title: string
  readonly state: StepState
  /** What the state is, in a few words. */
  readonly words: string
}

export const STATE_WORDS: Readonly<Record<StepState, string>> = { done: 'done', open: 'open', problem: 'problem', none: 'not needed' }

/** The steps in their order; the same for everybody who looks, as the server keeps what was done. */
export function stepsOf(stop: CellStop): readonly RecoveryStep[] {
  return [
    restStep(stop),
    enableStep(stop),
    partsStep(stop),
    jogStep(stop),
    homeStep(stop),
    resetStep(stop),
    releaseStep(stop),
    runsStep(stop),
  ]
}

/** The first step that somebody has to do something about. */
export function nextStep(steps: readonly RecoveryStep[]): StepId | undefined {
  return (steps.find((step) => step.state === 'problem' && step.id === 'rest') ?? steps.find((step) => step.state === 'open'))?.id
}

/** What a stop did at a device. */
export function deviceWords({ status, after_s, reason }: StoppedDevice): string {
  if (status === 'at_rest') return `at rest after ${after_s < 0.1 ? 'less than 0.1' : after_s.toFixed(1)} s`
  if (status === 'failed') return `has not confirmed that it is at rest: ${reason}`
  return 'comes to rest'
}

/** What a tool holds, as it is called in a sentence. */
export function partWords(part: string): string {
  return part === '?' ? 'a part whose name is not known' : part
}

/** Arms that hold something of which nobody has decided whether they keep it. */
export function undecided(stop: CellStop): readonly ArmRecovery[] {
  return stop.arms.filter((arm) => arm.part !== '' && !arm.kept)
}

/** Why the stop cannot be released now; undefined where it can. */
export function releaseObstacle(stop: CellStop): string | undefined {
  if (stop.phase === 'released') return 'it is released'
  if (stop.phase === 'stopping') return 'the stop is still in progress'
  const failed = stop.devices.find((device) => device.status !== 'at_rest')
  return failed && `${failed.name} has not confirmed that it is at rest: check it, then stop the cell once more`
}

function restStep(stop: CellStop): RecoveryStep {
  const step = { id: 'rest', title: 'Everything at rest' } as const
  const failed = stop.devices.filter((device) => device.status === 'failed')
  if (failed.length > 0) return { ...step, state: 'problem', words: `${names(failed)}: not confirmed` }
  const moving = stop.devices.filter((device) => device.status === 'stopping')
  if (moving.length > 0) return { ...step, state: 'open', words: `${names(moving)}: coming to rest` }
  return { ...step, state: 'done', words: stop.devices.length > 0 ? 'confirmed by every device' : 'the cell has no devices' }
}

function enableStep({ real }: CellStop): RecoveryStep {
  const step = { id: 'enable', title: 'Enable real devices' } as const
  if (real.length === 0) return { ...step, state: 'none', words: 'every device is simulated' }
  const lost = real.filter((device) => !device.connected)
  if (lost.length > 0) return { ...step, state: 'problem', words: `${names(lost)}: connect the cell again first` }
  const stopped = real.filter((device) => !device.enabled)
  if (stopped.length > 0) return { ...step, state: 'open', words: `${names(stopped)}: may not move` }
  return { ...step, state: 'done', words: `${names(real)}: may move` }
}

function partsStep(stop: CellStop): RecoveryStep {
  const step = { id: 'parts', title: 'What the arms hold' } as const
  const holding = stop.arms.filter((arm) => arm.part !== '')
  if (holding.length === 0) return { ...step, state: 'none', words: 'no arm holds a part' }
  const open = undecided(stop)
  if (open.length > 0) return { ...step, state: 'open', words: `${names(open)}: keep or release` }
  return { ...step, state: 'done', words: `${names(holding)}: kept` }
}

function jogStep(stop: CellStop): RecoveryStep {
  const step = { id: 'jog', title: 'Jog out of the way' } as const
  const moved = stop.arms.filter((arm) => arm.has_moved)
  if (stop.arms.length === 0) return { ...step, state: 'none', words: 'the cell has no arms' }
  if (moved.length > 0) return { ...step, state: 'done', words: `${names(moved)}: moved since the stop` }
  if (stop.arms.every((arm) => arm.at_home)) return { ...step, state: 'none', words: 'every arm is at home' }
  return { ...step, state: 'open', words: 'if an arm is in the way, or cannot go home' }
}

function homeStep(stop: CellStop): RecoveryStep {
  const step = { id: 'home', title: 'Go home' } as const
  if (stop.arms.length === 0) return { ...step, state: 'none', words: 'the cell has no arms' }
  const missing = stop.arms.filter((arm) => arm.home === '')
  const open = stop.arms.filter((arm) => arm.home !== '' && !arm.at_home)
  if (open.length > 0) return { ...step, state: 'open', words: `${names(open)}: not at home` }
  if (missing.length > 0) return { ...step, state: 'problem', words: `${names(missing)}: no home is known` }
  return { ...step, state: 'done', words: 'every arm is at home' }
}

function resetStep(stop: CellStop): RecoveryStep {
  const step = { id: 'reset', title: 'Reset the parts' } as const
  if (stop.parts === 'absent') return { ...step, state: 'none', words: 'only a simulation can do this' }
  return stop.parts === 'reset'
    ? { ...step, state: 'done', words: 'at their initial poses' }
    : { ...step, state: 'open', words: 'if the next run starts from the beginning' }
}

function releaseStep(stop: CellStop): RecoveryStep {
  const step = { id: 'release', title: 'Release the stop' } as const
  if (stop.phase === 'released') return { ...step, state: 'done', words: 'runs can start' }
  return { ...step, state: 'open', words: 'no run starts before' }
}

function runsStep(stop: CellStop): RecoveryStep {
  const step = { id: 'runs', title: 'Resume or end the runs' } as const
  if (stop.runs.length === 0) return { ...step, state: 'none', words: 'no run was stopped' }
  const count = stop.runs.length === 1 ? '1 run was stopped' : `${stop.runs.length} runs were stopped`
  return { ...step, state: 'open', words: stop.phase === 'released' ? count : `${count}; after the release` }
}

function names(them: readonly { readonly name: string }[]): string {
  return them.map((each) => each.name).join(', ')
}

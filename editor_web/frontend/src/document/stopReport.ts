/** What became of a STOP of the cell, in words: from the stop process, from the engine, and from the time that passed. Pure. */

import type { DeviceStop, StopStatus } from '../api/types'

/** One of the two ways that a STOP takes at the same time. */
export interface StopPath {
  readonly status: 'asked' | 'answered' | 'failed' | 'absent'
  /** Why it failed. */
  readonly problem: string
}

export interface StopProgress {
  /** Counts the stops of this page. */
  readonly number: number
  readonly process: StopPath
  /** The newest answer of the stop process. */
  readonly answer: StopStatus | undefined
  /** The engine's own stop, which answers once every robot is measured at rest. */
  readonly engine: StopPath
  /** No path has answered within its time. */
  readonly isUnanswered: boolean
  /** Something still moves after its time. */
  readonly isSlow: boolean
  /** When the engine was heard last, in words; empty where it never was. */
  readonly heard: string
}

export interface StopReport {
  /** `alarm` asks for the emergency stop. */
  readonly level: 'waiting' | 'done' | 'warning' | 'alarm'
  readonly title: string
  readonly lines: readonly string[]
}

export const EMERGENCY = 'Press the emergency stop at the cell.'

/** A STOP that has just been sent. */
export function newStop(number: number, hasProcess: boolean, heard: string): StopProgress {
  const asked: StopPath = { status: 'asked', problem: '' }
  const process: StopPath = hasProcess ? asked : { status: 'absent', problem: '' }
  return { number, process, answer: undefined, engine: asked, isUnanswered: false, isSlow: false, heard }
}

export function isAcknowledged({ answer, engine }: StopProgress): boolean {
  return answer?.acknowledged === true || engine.status === 'answered'
}

/** Whether nothing moves any more, by the devices' own words where there are any. */
export function isAtRest({ answer, engine }: StopProgress): boolean {
  return answer?.acknowledged ? answer.devices.every((device) => device.at_rest) : engine.status === 'answered'
}

export function reportOf(stop: StopProgress): StopReport {
  if (!isAcknowledged(stop)) return unacknowledged(stop)
  const deaf = namesOf(stop, (device) => !device.acknowledged)
  const moving = namesOf(stop, (device) => !device.at_rest)
  if (deaf) return { level: 'alarm', title: `Not acknowledged by ${deaf}`, lines: [EMERGENCY, ...notes(stop)] }
  if (isAtRest(stop)) return { level: notes(stop).length > 0 ? 'warning' : 'done', title: 'All arms at rest', lines: notes(stop) }
  if (stop.isSlow) return { level: 'alarm', title: `Stop acknowledged, but not at rest: ${moving}`, lines: [EMERGENCY, ...notes(stop)] }
  return { level: 'waiting', title: 'Stop acknowledged', lines: [`Coming to rest: ${moving}`, ...notes(stop)] }
}

function unacknowledged({ process, engine, isUnanswered }: StopProgress): StopReport {
  const problems = [
    process.status === 'failed' && `Stop process: ${process.problem}`,
    engine.status === 'failed' && `Engine: ${engine.problem}`,
  ].filter((line) => line !== false)
  const hasFailed = process.status !== 'asked' && engine.status === 'failed'
  if (hasFailed) return { level: 'alarm', title: 'STOP has failed', lines: [EMERGENCY, ...problems] }
  if (isUnanswered) return { level: 'alarm', title: 'STOP is not acknowledged', lines: [EMERGENCY, ...problems] }
  return { level: 'waiting', title: 'Stopping', lines: problems }
}

/** What is to be known beside it: which of the two paths does not work. */
function notes({ answer, engine, process, heard }: StopProgress): readonly string[] {
  const silent = answer?.engine === 'silent' && engine.status !== 'answered'
  const since = heard ? ` (silent since ${heard})` : ''
  return [
    silent && `Engine does not answer${since}; arms are stopped by their controller.`,
    !silent && engine.status === 'failed' && `The engine did not take the stop: ${engine.problem}`,
    process.status === 'failed' && `The stop process did not answer: ${process.problem}`,
  ].filter((line) => line !== false)
}

function namesOf({ answer }: StopProgress, is: (device: DeviceStop) => boolean): string {
  return (answer?.devices ?? [])
    .filter(is)
    .map((device) => device.name)
    .join(', ')
}

/** Times in words; never throws, whatever the browser's locale is called. */
import type { RunView } from '../api/types'

/** `0.42 s`, `12.3 s`, `3:05 min`, `1:02:03 h`. */
export function duration(seconds: number): string {
  if (!Number.isFinite(seconds) || seconds < 0) return '–'
  if (seconds < 10) return `${seconds.toFixed(2)} s`
  if (seconds < 60) return `${seconds.toFixed(1)} s`
  const whole = Math.floor(seconds)
  const parts = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60]
  if (parts[0] === 0) return `${parts[1]}:${pad(parts[2] ?? 0)} min`
  return `${parts[0]}:${pad(parts[1] ?? 0)}:${pad(parts[2] ?? 0)} h`
}

/** `14:03:27` in the viewer's time zone; with the date when it is not today's. */
export function wallTime(secondsSince1970: number, now: Date = new Date()): string {
  const at = new Date(secondsSince1970 * 1000)
  const time = [at.getHours(), at.getMinutes(), at.getSeconds()].map(pad).join(':')
  if (at.toDateString() === now.toDateString()) return time
  return `${at.getFullYear()}-${pad(at.getMonth() + 1)}-${pad(at.getDate())} ${time}`
}

type Started = Pick<RunView, 'id' | 'behavior' | 'started_at_s'>

/** Digits of a second: as many as tell a run from each other one of its behavior. */
const DIGITS = [0, 2, 3, 6]

/** When a run was started, to as many digits of the second as distinguish it from the others of its behavior. */
export function startTime(run: Started, among: readonly Started[]): string {
  const others = among.filter((each) => each.id !== run.id && each.behavior === run.behavior)
  const digits = DIGITS.find((many) => others.every((each) => preciseTime(each, many) !== preciseTime(run, many)))
  return preciseTime(run, digits ?? Math.max(...DIGITS))
}

function preciseTime({ started_at_s }: Started, digits: number): string {
  const start = wallTime(started_at_s)
  if (digits === 0) return start
  // The clock of the server has microseconds.
  const micros = Math.min(Math.round((started_at_s % 1) * 1e6), 999_999)
  return `${start}.${String(micros).padStart(6, '0').slice(0, digits)}`
}

function pad(part: number): string {
  return String(part).padStart(2, '0')
}

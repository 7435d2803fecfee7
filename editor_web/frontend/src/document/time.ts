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

/** When a run was started, to the hundredth where another one of its behavior was started in the same second. */
export function startTime(run: Started, among: readonly Started[]): string {
  const start = wallTime(run.started_at_s)
  const hasTwin = among.some((each) => each.id !== run.id && each.behavior === run.behavior && wallTime(each.started_at_s) === start)
  return hasTwin ? `${start}.${pad(Math.floor((run.started_at_s % 1) * 100))}` : start
}

function pad(part: number): string {
  return String(part).padStart(2, '0')
}

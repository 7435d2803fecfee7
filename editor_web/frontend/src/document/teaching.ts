/** What the page for teaching works out by itself: names, velocities, poses in words, what a change moves. */
import type { JogBlockFrame, Trace } from '../api/types'

export type Space = 'joints' | 'tool'
export type Frame = 'world' | 'base' | 'tool'

/** How fast a jog is at full speed. */
export const MOST_M_S = 0.25
export const MOST_RAD_S = 1.0

/** The axes of the tool: along three, about three. */
export const TOOL_AXES = ['X', 'Y', 'Z', 'RX', 'RY', 'RZ'] as const

const NAME = /^[a-z][a-z0-9_/.-]{0,127}$/
const TAG = /^[a-z0-9][a-z0-9_/.-]{0,63}$/

/** Why this cannot be the name of an entry; empty where it can. */
export function nameFault(name: string): string {
  if (name === '') return 'Give it a name'
  if (!/^[a-z]/.test(name)) return 'A name begins with a lower-case letter'
  if (name.length > 128) return 'A name has 128 characters at most'
  return NAME.test(name) ? '' : 'A name has only a–z, 0–9 and _ / . -'
}

/** Tags as typed, separated by commas or blanks. */
export function tagsOf(typed: string): readonly string[] {
  return [...new Set(typed.split(/[\s,]+/).filter(Boolean))]
}

/** Why these cannot be tags; empty where they can. */
export function tagFault(typed: string): string {
  const tags = tagsOf(typed)
  if (tags.length > 32) return 'At most 32 tags'
  const wrong = tags.find((tag) => !TAG.test(tag))
  return wrong === undefined ? '' : `“${wrong}” has only a–z, 0–9 and _ / . - in a tag`
}

/** The velocity of a jog along one axis, or of one joint; `share` of full speed, negative for the other way. */
export function jogVelocity(space: Space, axis: number, share: number, joints: number): readonly number[] {
  const width = space === 'tool' ? 6 : joints
  const full = space === 'tool' && axis < 3 ? MOST_M_S : MOST_RAD_S
  return Array.from({ length: width }, (_, at) => (at === axis ? share * full : 0))
}

/** A step along one axis of the tool: `step_m` and `turn_rad`. */
export function toolStep(
  axis: number,
  step_m: number,
  turn_rad: number,
): { readonly step_m: readonly number[]; readonly turn_rad: readonly number[] } {
  const along = (of: number, size: number) => [0, 1, 2].map((at) => (at === of ? size : 0))
  return { step_m: along(axis, step_m), turn_rad: along(axis - 3, turn_rad) }
}

export function degrees(rad: number): number {
  return (rad * 180) / Math.PI
}

/** Roll, pitch and yaw in radians of a unit quaternion x y z w. */
export function rollPitchYaw(xyzw: readonly number[]): readonly [number, number, number] {
  const [x = 0, y = 0, z = 0, w = 1] = xyzw
  const sine = Math.max(-1, Math.min(1, 2 * (w * y - z * x)))
  return [
    Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
    Math.asin(sine),
    Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
  ]
}

/** How near a joint is to its limits: 0 at the lower, 1 at the upper one. */
export function shareOfRange(value: number, lower: number, upper: number): number {
  return upper > lower ? Math.max(0, Math.min(1, (value - lower) / (upper - lower))) : 0.5
}

/** What of a motion another form of it keeps: its end, for a configuration or a pose. */
export function endOf(trace: Trace): Trace {
  const last = trace.poses.length - 1
  return { ...trace, times_s: [0], joints: trace.joints.slice(last), poses: trace.poses.slice(last) }
}

/** What the arm will do otherwise when `after` takes the place of `before`, one fact a line. */
export function changesOf(before: Trace, after: Trace): readonly string[] {
  const changes: string[] = []
  const isMotion = before.poses.length > 1 || after.poses.length > 1
  if (isMotion) push(changes, 'starts', distance(before.poses[0], after.poses[0]))
  push(changes, isMotion ? 'ends' : 'moves by', distance(before.poses.at(-1), after.poses.at(-1)))
  const joint = farthestJoint(before, after)
  if (joint) changes.push(joint)
  const lasted = before.times_s.at(-1) ?? 0
  const lasts = after.times_s.at(-1) ?? 0
  if (Math.abs(lasts - lasted) > 0.005) changes.push(`lasts ${lasts.toFixed(2)} s instead of ${lasted.toFixed(2)} s`)
  return changes.length > 0 ? changes : ['is the same']
}

function push(changes: string[], what: string, far_m: number | undefined): void {
  if (far_m === undefined || far_m < 0.0005) return
  changes.push(what === 'moves by' ? `the tool ${what} ${millimetres(far_m)}` : `${what} ${millimetres(far_m)} away`)
}

function millimetres(far_m: number): string {
  return far_m < 0.1 ? `${(far_m * 1000).toFixed(1)} mm` : `${(far_m * 100).toFixed(1)} cm`
}

function distance(one: readonly number[] | undefined, two: readonly number[] | undefined): number | undefined {
  if (!one || !two) return undefined
  return Math.hypot(...[0, 1, 2].map((at) => (one[at] ?? 0) - (two[at] ?? 0)))
}

function farthestJoint(before: Trace, after: Trace): string {
  const one = before.joints.at(-1)
  const two = after.joints.at(-1)
  if (!one || !two || one.length !== two.length) return ''
  const turns = one.map((value, at) => Math.abs(value - (two[at] ?? 0)))
  const most = Math.max(...turns)
  if (most < 0.001) return ''
  return `joint ${turns.indexOf(most) + 1} ends ${degrees(most).toFixed(1)}° away`
}

/** One curve of a plot. */
export interface Curve {
  readonly name: string
  readonly times_s: readonly number[]
  readonly values: readonly number[]
}

/** One joint (degrees) or one coordinate of the tool (millimetres) over time. */
export function curveOf(trace: Trace, name: string, channel: string): Curve {
  const [space, index] = channel.split(' ')
  const at = Number(index)
  const rows = space === 'joint' ? trace.joints.map((row) => degrees(row[at] ?? 0)) : trace.poses.map((row) => (row[at] ?? 0) * 1000)
  return { name, times_s: trace.times_s.slice(0, rows.length), values: rows }
}

/** The greatest and the root mean square distance of two curves where both are, in the curves' unit. */
export function apart(one: Curve, two: Curve): { readonly rms: number; readonly most: number } | undefined {
  const from = Math.max(one.times_s[0] ?? 0, two.times_s[0] ?? 0)
  const to = Math.min(one.times_s.at(-1) ?? 0, two.times_s.at(-1) ?? 0)
  const inside = one.times_s.map((time, at) => [time, one.values[at] ?? 0] as const).filter(([time]) => time >= from && time <= to)
  if (inside.length < 2) return undefined
  return summed(inside.map(([time, value]) => Math.abs(value - valueAt(two, time))))
}

/** How far what was learned is from what was shown: of the joints (rad) and of the tool (m). */
export interface Errors {
  readonly joints: { readonly rms: number; readonly most: number } | undefined
  readonly tool: { readonly rms: number; readonly most: number } | undefined
}

/** The errors in joint and task space, at the times of `shown` at which there is something of both. */
export function errorsOf(shown: Trace, learned: Trace): Errors {
  const joints = shown.joints.length > 0 && learned.joints.length > 0 ? (shown.joints[0]?.length ?? 0) : 0
  const turns = distances(shown, learned, joints, 'joints')
  const moves = distances(shown, learned, 3, 'poses')
  return { joints: summed(turns.flat()), tool: summed(moves.map((each) => Math.hypot(...each))) }
}

/** For each time the distances of the first columns. */
function distances(one: Trace, two: Trace, columns: number, rows: 'joints' | 'poses'): readonly (readonly number[])[] {
  const from = Math.max(one.times_s[0] ?? 0, two.times_s[0] ?? 0)
  const to = Math.min(one.times_s.at(-1) ?? 0, two.times_s.at(-1) ?? 0)
  const curves = Array.from({ length: columns }, (_, at) => ({
    name: '',
    times_s: two.times_s,
    values: two[rows].map((row) => row[at] ?? 0),
  }))
  const made: number[][] = []
  one.times_s.forEach((time, index) => {
    if (time < from || time > to || columns === 0) return
    made.push(curves.map((curve, at) => Math.abs((one[rows][index]?.[at] ?? 0) - valueAt(curve, time))))
  })
  return made
}

function summed(errors: readonly number[]): { readonly rms: number; readonly most: number } | undefined {
  if (errors.length === 0) return undefined
  return { rms: Math.sqrt(errors.reduce((sum, each) => sum + each * each, 0) / errors.length), most: Math.max(...errors) }
}

function valueAt(curve: Curve, time_s: number): number {
  const next = curve.times_s.findIndex((each) => each >= time_s)
  if (next <= 0) return curve.values[Math.max(next, 0)] ?? 0
  const [t0 = 0, t1 = 1] = [curve.times_s[next - 1], curve.times_s[next]]
  const [v0 = 0, v1 = 0] = [curve.values[next - 1], curve.values[next]]
  return v0 + ((v1 - v0) * (time_s - t0)) / (t1 - t0)
}

/** What is said of a press that has moved nothing. */
export function droppedWords(within_s: number): string {
  return `The press was dropped: the arm could not move within ${within_s} s of its release. Hold it for longer.`
}

/** What is said while a jog key is held: whether the arm moves already, else what it waits for. */
export function heldWords(mode: string | undefined, activity: string | undefined): string {
  if (mode === 'jogging') return 'It moves while this is held'
  return `Keep holding: it waits ${activity ? `(${activity})` : 'until its path can be checked'}`
}

/** What a jogged arm stands before, how near it is, and which of the directions `names` lead out. */
export function blockWords(block: JogBlockFrame, names: readonly string[]): string {
  if (block.distance_m === null) return `${block.first} stands before ${block.second}.`
  const millimetres_away = (block.distance_m * 1000).toFixed(1)
  const directions = block.directions_out.map((each) => `${names[each.axis] ?? each.axis + 1} ${each.sign > 0 ? 'plus' : 'minus'}`)
  const out =
    directions.length > 0 ? `Directions out: ${directions.join(', ')}.` : 'No direction leads out: lead the arm by hand, or jog its joints.'
  return `${block.first} stands ${millimetres_away} mm before ${block.second}. ${out}`
}

/** What can be seen of a named entry before it is used: where an arm would be, in numbers with their units. Pure. */
import { lookup, type Dict } from '../dict'
import type { Trace } from '../../api/types'
import { degrees, rollPitchYaw } from '../teaching'
import { duration } from '../time'
import type { EntryLine } from './entryText'
import { isTemplate } from './fields'

type Mapping = Dict<unknown>

/** What entries that have a place are called. */
export const PLACED: Dict<string> = {
  joints: 'Joints',
  pose: 'Pose',
  trajectory: 'Recording',
  dmp: 'Motion, joints',
  cart_dmp: 'Motion, tool',
}

// The names that states give their arm.
const ARM_KEYS = ['robot', 'arm']
const REFERENCE = /^\$\{\s*([A-Za-z_]\w*)\s*\}$/

/** The name of an entry in the value of a parameter: the value itself, or beside what else is said of it. */
export function entryNamed(value: unknown): string | undefined {
  if (typeof value === 'string') return value
  if (typeof value !== 'object' || value === null || Array.isArray(value)) return undefined
  const { entry } = value as { entry?: unknown }
  return typeof entry === 'string' ? entry : undefined
}

/** A text as it is unless a run is started with other parameters; undefined where only the run knows. */
export function byDefault(text: string, parameters: Dict<Mapping>): string | undefined {
  if (!isTemplate(text)) return text
  const name = REFERENCE.exec(text)?.[1]
  const fallback = name === undefined ? undefined : entryNamed(lookup(parameters, name)?.['default'])
  return fallback !== undefined && !isTemplate(fallback) ? fallback : undefined
}

/** The arm that a state moves, by default, or whose tool it moves, where the robots are known; empty where nothing says which. */
export function armOf(given: Mapping, parameters: Dict<Mapping>, robots: readonly string[] = []): string {
  const isText = (value: unknown): value is string => typeof value === 'string'
  const arm = ARM_KEYS.map((key) => lookup(given, key)).find(isText)
  if (arm !== undefined) return byDefault(arm, parameters) ?? ''
  const named = Object.values(given).filter(isText)
  return named.map((each) => byDefault(each, parameters) ?? '').find((each) => robots.includes(each)) ?? ''
}

/** Where the arm would be: of a motion how long it takes, how far the tool goes, and its end. */
export function traceLines(trace: Trace): readonly EntryLine[] {
  const isMotion = trace.poses.length > 1
  const joints = trace.joints.at(-1)
  const pose = trace.poses.at(-1)
  const lines: EntryLine[] = []
  if (isMotion)
    lines.push({ label: 'Motion', words: `${duration(trace.times_s.at(-1) ?? 0)}, ${pathLength(trace).toFixed(2)} m of the tool` })
  if (joints)
    lines.push({ label: isMotion ? 'Joints at the end' : 'Joints', words: `${joints.map((value) => tenths(degrees(value))).join('  ')} °` })
  if (pose) {
    lines.push(
      {
        label: isMotion ? 'Tool at the end' : 'Tool',
        words: `${pose
          .slice(0, 3)
          .map((value) => tenths(value * 1000))
          .join('  ')} mm`,
      },
      {
        label: 'Roll, pitch, yaw',
        words: `${rollPitchYaw(pose.slice(3))
          .map((value) => tenths(degrees(value)))
          .join('  ')} °`,
      },
    )
  }
  return lines
}

function pathLength({ poses }: Trace): number {
  return poses
    .slice(1)
    .reduce((sum, pose, at) => sum + Math.hypot(...[0, 1, 2].map((axis) => (pose[axis] ?? 0) - (poses[at]?.[axis] ?? 0))), 0)
}

/** Without the minus of what is rounded to zero. */
function tenths(value: number): string {
  return value.toFixed(1).replace(/^-(0\.0)$/, '$1')
}

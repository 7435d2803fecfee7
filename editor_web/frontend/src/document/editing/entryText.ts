/** What is in a named entry, in lines that people can compare with a cell. Pure. */
import type { Dict } from '../dict'

export interface EntryLine {
  readonly label: string
  readonly words: string
}

const MOST = 12
const LONGEST = 60

export function entryLines(kind: string, value: Dict<unknown>): readonly EntryLine[] {
  if (kind === 'joints') return jointLines(value)
  if (kind === 'pose') return poseLines(value)
  return Object.entries(value)
    .slice(0, MOST)
    .map(([label, each]) => ({ label, words: short(each) }))
}

function jointLines(value: Dict<unknown>): readonly EntryLine[] {
  const names = Array.isArray(value['names']) ? value['names'] : []
  return numbersOf(value['joints'])
    .slice(0, MOST)
    .map((angle, index) => ({
      label: typeof names[index] === 'string' ? names[index] : `joint ${index + 1}`,
      words: `${angle.toFixed(3)} (${degrees(angle)}°)`,
    }))
}

function poseLines(value: Dict<unknown>): readonly EntryLine[] {
  const xyz = numbersOf(value['xyz'])
  const turn = numbersOf(value['xyzw'])
  const frame = value['frame']
  return [
    { label: 'place', words: `${xyz.map((each) => each.toFixed(3)).join(', ')} m` },
    ...(turn.length === 4 ? [{ label: 'roll, pitch, yaw', words: `${rollPitchYaw(turn).map(degrees).join(', ')}°` }] : []),
    ...(typeof frame === 'string' && frame ? [{ label: 'frame', words: frame }] : []),
  ]
}

function numbersOf(value: unknown): readonly number[] {
  return Array.isArray(value) ? value.filter((each): each is number => typeof each === 'number') : []
}

/** Of a unit quaternion x, y, z, w; radians, about the fixed axes x, y, z. */
function rollPitchYaw(turn: readonly number[]): readonly number[] {
  const [x = 0, y = 0, z = 0, w = 1] = turn
  return [
    Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
    Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x)))),
    Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
  ]
}

function degrees(angle_rad: number): string {
  const rounded = Math.round((angle_rad * 1800) / Math.PI) / 10
  return (rounded === 0 ? 0 : rounded).toFixed(1)
}

function short(value: unknown): string {
  const words = typeof value === 'string' ? value : (JSON.stringify(value) ?? '')
  return words.length > LONGEST ? `${words.slice(0, LONGEST)}…` : words
}

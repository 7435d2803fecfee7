/** Poses and what is made of taught points: frames, grids, boxes. Metres, quaternions x y z w of unit length. Pure. */
import { fieldsOf, lookup } from './dict'

export type Vector = readonly [number, number, number]
export type Quaternion = readonly [number, number, number, number]

export interface PlacedPose {
  readonly xyz: Vector
  readonly xyzw: Quaternion
}

/** The frame of a pose that names none. */
export const WORLD = 'world'
export const NO_TURN: Quaternion = [0, 0, 0, 1]
/** Half a turn about x: a tool that looks along z looks back along it. */
export const FLIPPED: Quaternion = [1, 0, 0, 0]

/** Points of a frame nearer than this are one point. */
const NEAREST_M = 0.005
/** Directions that differ by less are one direction. */
const SMALLEST_ANGLE_RAD = (2 * Math.PI) / 180

export function add(a: Vector, b: Vector): Vector {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

export function subtract(a: Vector, b: Vector): Vector {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

export function scaled(a: Vector, by: number): Vector {
  return [a[0] * by, a[1] * by, a[2] * by]
}

export function distance(a: Vector, b: Vector): number {
  return Math.hypot(...subtract(a, b))
}

export function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

export function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

function unit(a: Vector): Vector {
  return scaled(a, 1 / Math.hypot(...a))
}

/** The turn by `b`, then by `a`. */
export function multiplied(a: Quaternion, b: Quaternion): Quaternion {
  const [x, y, z, w] = a
  const [p, q, r, s] = b
  return [w * p + x * s + y * r - z * q, w * q - x * r + y * s + z * p, w * r + x * q - y * p + z * s, w * s - x * p - y * q - z * r]
}

export function inverted([x, y, z, w]: Quaternion): Quaternion {
  return [-x, -y, -z, w]
}

export function rotated(turn: Quaternion, v: Vector): Vector {
  const axis: Vector = [turn[0], turn[1], turn[2]]
  const twice = scaled(cross(axis, v), 2)
  return add(add(v, scaled(twice, turn[3])), cross(axis, twice))
}

/** A pose given in a frame, as it is in the world. */
export function inWorld(pose: PlacedPose, frame: PlacedPose): PlacedPose {
  return { xyz: add(frame.xyz, rotated(frame.xyzw, pose.xyz)), xyzw: normalised(multiplied(frame.xyzw, pose.xyzw)) }
}

/** A pose of the world, as it is seen from a frame. */
export function seenFrom(pose: PlacedPose, frame: PlacedPose): PlacedPose {
  const back = inverted(frame.xyzw)
  return { xyz: rotated(back, subtract(pose.xyz, frame.xyz)), xyzw: normalised(multiplied(back, pose.xyzw)) }
}

/** Of length 1, and of the two that mean the same turn the one with w ≥ 0. */
export function normalised(turn: Quaternion): Quaternion {
  const length = Math.hypot(...turn) * (turn[3] < 0 ? -1 : 1)
  return length === 0 ? NO_TURN : [turn[0] / length, turn[1] / length, turn[2] / length, turn[3] / length]
}

/** The turn of a roll about x, then a pitch about y, then a yaw about z of the fixed axes, radians. */
export function turnOf([roll, pitch, yaw]: Vector): Quaternion {
  const about = (axis: 0 | 1 | 2, angle: number): Quaternion => {
    const sine = Math.sin(angle / 2)
    return [axis === 0 ? sine : 0, axis === 1 ? sine : 0, axis === 2 ? sine : 0, Math.cos(angle / 2)]
  }
  return normalised(multiplied(about(2, yaw), multiplied(about(1, pitch), about(0, roll))))
}

/** The turn whose axes are these, which are of unit length and at right angles. */
function turnOfAxes(x: Vector, y: Vector, z: Vector): Quaternion {
  const trace = x[0] + y[1] + z[2]
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1)
    return normalised([(y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s, s / 4])
  }
  if (x[0] >= y[1] && x[0] >= z[2]) {
    const s = 2 * Math.sqrt(1 + x[0] - y[1] - z[2])
    return normalised([s / 4, (y[0] + x[1]) / s, (z[0] + x[2]) / s, (y[2] - z[1]) / s])
  }
  if (y[1] >= z[2]) {
    const s = 2 * Math.sqrt(1 + y[1] - x[0] - z[2])
    return normalised([(y[0] + x[1]) / s, s / 4, (z[1] + y[2]) / s, (z[0] - x[2]) / s])
  }
  const s = 2 * Math.sqrt(1 + z[2] - x[0] - y[1])
  return normalised([(z[0] + x[2]) / s, (z[1] + y[2]) / s, s / 4, (x[1] - y[0]) / s])
}

/** The angle at a point between the directions to two others, in radians. */
export function angleAt(point: Vector, one: Vector, other: Vector): number {
  const [a, b] = [subtract(one, point), subtract(other, point)]
  return Math.atan2(Math.hypot(...cross(a, b)), dot(a, b))
}

/** A pose, or why there is none. */
export type Made<T> = { readonly value: T; readonly fault?: undefined } | { readonly value?: undefined; readonly fault: string }

/**
 * The frame at `origin` whose x axis goes through `onX`; `onY` says on which side the y axis is.
 *
 * It need not stand at a right angle: the y axis is turned to one, in the plane of the three points.
 */
export function threePointFrame(origin: Vector, onX: Vector, onY: Vector): Made<PlacedPose> {
  const toX = subtract(onX, origin)
  const toY = subtract(onY, origin)
  const short = [
    ['the point on x', toX],
    ['the point on y', toY],
  ] as const
  for (const [what, to] of short)
    if (Math.hypot(...to) < NEAREST_M)
      return { fault: `${what} is ${millimetres(Math.hypot(...to))} from the origin, at least ${millimetres(NEAREST_M)} are needed` }
  const x = unit(toX)
  const sine = Math.hypot(...cross(x, unit(toY)))
  if (sine < Math.sin(SMALLEST_ANGLE_RAD)) {
    const angle = ((Math.asin(Math.min(1, sine)) * 180) / Math.PI).toFixed(1)
    return { fault: `the three points are on one line, but for ${angle}°: move the point on y to the side` }
  }
  const z = unit(cross(x, toY))
  return { value: { xyz: origin, xyzw: turnOfAxes(x, cross(z, x), z) } }
}

export interface GridCorners {
  /** The first place. */
  readonly first: Vector
  /** The last place of the first row. */
  readonly rowEnd: Vector
  /** The first place of the last row. */
  readonly columnEnd: Vector
}

/** The places of a grid row by row; with `isSerpentine` every other row goes back. */
export function gridPoints(
  { first, rowEnd, columnEnd }: GridCorners,
  columns: number,
  rows: number,
  isSerpentine = false,
): Made<readonly Vector[]> {
  if (!Number.isInteger(columns) || !Number.isInteger(rows) || columns < 1 || rows < 1)
    return { fault: 'columns and rows are whole numbers from 1' }
  const along = subtract(rowEnd, first)
  const down = subtract(columnEnd, first)
  if (columns > 1 && Math.hypot(...along) < NEAREST_M) return { fault: 'the end of the row is at the first place' }
  if (rows > 1 && Math.hypot(...down) < NEAREST_M) return { fault: 'the end of the column is at the first place' }
  if (columns > 1 && rows > 1 && Math.hypot(...cross(unit(along), unit(down))) < Math.sin(SMALLEST_ANGLE_RAD))
    return { fault: 'the three corners are on one line' }
  const share = (at: number, of: number) => (of > 1 ? at / (of - 1) : 0)
  const value = Array.from({ length: rows * columns }, (_, index): Vector => {
    const row = Math.floor(index / columns)
    const inRow = index % columns
    const column = isSerpentine && row % 2 === 1 ? columns - 1 - inRow : inRow
    return add(first, add(scaled(along, share(column, columns)), scaled(down, share(row, rows))))
  })
  return { value }
}

/** The box that has both points for corners: its least and its greatest coordinates. */
export function boxOf(a: Vector, b: Vector): readonly [Vector, Vector] {
  const each = (of: (one: number, other: number) => number): Vector => [of(a[0], b[0]), of(a[1], b[1]), of(a[2], b[2])]
  return [each(Math.min), each(Math.max)]
}

/** Rounded as a document has it: to a tenth of a millimetre, without the sign of a zero. */
export function roundedTo<T extends readonly number[]>(values: T, digits = 4): T {
  return values.map((value) => Number(value.toFixed(digits)) + 0) as unknown as T
}

/** The first three of numbers, and the four after them; undefined where there are not as many. */
export function poseFrom(numbers: readonly number[] | undefined): PlacedPose | undefined {
  const [x, y, z, qx, qy, qz, qw] = numbers ?? []
  if (x === undefined || y === undefined || z === undefined) return undefined
  if (qx === undefined || qy === undefined || qz === undefined || qw === undefined) return undefined
  return { xyz: [x, y, z], xyzw: [qx, qy, qz, qw] }
}

/** Numbers as a vector; undefined where they are none. */
export function vectorFrom(value: unknown): Vector | undefined {
  const numbers = Array.isArray(value) ? (value as unknown[]) : []
  const [x, y, z] = numbers
  return typeof x === 'number' && typeof y === 'number' && typeof z === 'number' ? [x, y, z] : undefined
}

function millimetres(m: number): string {
  return `${(m * 1000).toFixed(1)} mm`
}

/** The frame that the value of a pose is in. */
export function frameOf(pose: unknown): string {
  const frame = lookup(fieldsOf(pose), 'frame')
  return typeof frame === 'string' && frame ? frame : WORLD
}

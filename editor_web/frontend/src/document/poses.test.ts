/** Poses seen from frames, and what is made of taught points. */
import { expect, it } from 'vitest'
import {
  add,
  boxOf,
  cross,
  distance,
  dot,
  gridPoints,
  inWorld,
  multiplied,
  normalised,
  poseFrom,
  rotated,
  roundedTo,
  scaled,
  seenFrom,
  subtract,
  angleAt,
  threePointFrame,
  turnOf,
  vectorFrom,
  type PlacedPose,
  type Quaternion,
  type Vector,
} from './poses'
import { rollPitchYaw } from './teaching'

const TIMES = 60
const X: Vector = [1, 0, 0]
const Y: Vector = [0, 1, 0]
const Z: Vector = [0, 0, 1]

/** Numbers in [-1, 1], the same in each run. */
function numbers(seed: number): () => number {
  let state = seed
  return () => {
    state = (state * 1103515245 + 12345) % 2 ** 31
    return (state / 2 ** 31) * 2 - 1
  }
}

function sampled(check: (vector: () => Vector, turn: () => Quaternion) => void): void {
  const next = numbers(7)
  const vector = (): Vector => [next(), next(), next()]
  for (let at = 0; at < TIMES; at += 1) check(vector, () => normalised([next(), next(), next(), next()]))
}

/** The greatest difference of two lists of numbers. */
function apart(one: readonly number[], other: readonly number[]): number {
  return one.length === other.length ? Math.max(...one.map((value, at) => Math.abs(value - (other[at] ?? NaN)))) : NaN
}

it('sees a pose from a frame, and finds it back in the world', () => {
  sampled((vector, turn) => {
    const pose: PlacedPose = { xyz: vector(), xyzw: turn() }
    const frame: PlacedPose = { xyz: vector(), xyzw: turn() }
    const back = inWorld(seenFrom(pose, frame), frame)
    expect(apart(back.xyz, pose.xyz)).toBeCloseTo(0, 9)
    expect(apart(back.xyzw, normalised(pose.xyzw))).toBeCloseTo(0, 9)
    expect(apart(seenFrom(frame, frame).xyz, [0, 0, 0])).toBeCloseTo(0, 9)
  })
})

it('turns without changing lengths, one turn after the other', () => {
  sampled((vector, turn) => {
    const [v, a, b] = [vector(), turn(), turn()]
    expect(Math.hypot(...rotated(a, v))).toBeCloseTo(Math.hypot(...v), 9)
    expect(apart(rotated(multiplied(a, b), v), rotated(a, rotated(b, v)))).toBeCloseTo(0, 9)
  })
})

it('makes the turn of roll, pitch and yaw that the page shows of it', () => {
  expect(apart(rotated(turnOf([0, 0, Math.PI / 2]), X), Y)).toBeCloseTo(0, 9)
  sampled((vector) => {
    const [roll, pitch, yaw] = vector()
    expect(apart(rollPitchYaw(turnOf([roll, pitch, yaw])), [roll, pitch, yaw])).toBeCloseTo(0, 9)
  })
})

it('makes of any three points a frame with right angles, through the point on x, with y on its side', () => {
  let made = 0
  sampled((vector) => {
    const [origin, onX, onY] = [vector(), vector(), vector()]
    const { value } = threePointFrame(origin, onX, onY)
    if (!value) return
    made += 1
    const [x, y, z] = [rotated(value.xyzw, X), rotated(value.xyzw, Y), rotated(value.xyzw, Z)]
    expect(Math.hypot(...value.xyzw)).toBeCloseTo(1, 9)
    expect(apart(x, scaled(subtract(onX, origin), 1 / distance(onX, origin)))).toBeCloseTo(0, 9)
    expect(apart(cross(x, y), z)).toBeCloseTo(0, 9)
    expect(dot(subtract(onY, origin), z)).toBeCloseTo(0, 9)
    expect(dot(subtract(onY, origin), y)).toBeGreaterThan(0)
    expect(apart(value.xyz, origin)).toBeCloseTo(0, 9)
  })
  expect(made).toBeGreaterThan(TIMES / 2)
})

it('does not depend on how far the points of a frame are', () => {
  const turns: number[] = []
  sampled((vector) => {
    const [origin, toX, toY] = [vector(), vector(), vector()]
    const one = threePointFrame(origin, add(origin, toX), add(origin, toY)).value
    const far = threePointFrame(origin, add(origin, scaled(toX, 3)), add(origin, add(scaled(toY, 2), scaled(toX, 0.5)))).value
    if (one && far) turns.push(apart(far.xyzw, one.xyzw))
  })
  expect(turns.length).toBeGreaterThan(TIMES / 2)
  expect(Math.max(...turns)).toBeCloseTo(0, 6)
})

it.each([
  ['on one line', [0.2, 0.001, 0] as Vector, 'on one line, but for 0.3°'],
  ['on one line backwards', [-0.2, 0, 0] as Vector, 'on one line'],
  ['too near', [0, 0.004, 0] as Vector, 'the point on y is 4.0 mm from the origin'],
])('refuses points that are %s', (_, onY, words) => {
  expect(threePointFrame([0, 0, 0], [0.1, 0, 0], onY).fault).toContain(words)
})

it('says which point is too near', () => {
  expect(threePointFrame([1, 1, 1], [1, 1, 1.001], [2, 1, 1]).fault).toContain('the point on x is 1.0 mm')
})

it('lays a grid from corner to corner, row by row', () => {
  const corners = { first: [0, 0, 0.1], rowEnd: [0.2, 0, 0.1], columnEnd: [0, 0.1, 0.2] } as const
  expect(gridPoints(corners, 3, 2).value?.map((each) => roundedTo(each))).toEqual([
    [0, 0, 0.1],
    [0.1, 0, 0.1],
    [0.2, 0, 0.1],
    [0, 0.1, 0.2],
    [0.1, 0.1, 0.2],
    [0.2, 0.1, 0.2],
  ])
  expect(gridPoints(corners, 3, 2, true).value?.at(3)).toEqual([0.2, 0.1, 0.2])
})

it('has the corners of each grid in it, once, and equal steps', () => {
  sampled((vector) => {
    const corners = { first: vector(), rowEnd: vector(), columnEnd: vector() }
    const { value } = gridPoints(corners, 4, 3)
    if (!value) return
    expect(value).toHaveLength(12)
    expect(apart(value[0] ?? [], corners.first)).toBeCloseTo(0, 9)
    expect(apart(value[3] ?? [], corners.rowEnd)).toBeCloseTo(0, 9)
    expect(apart(value[8] ?? [], corners.columnEnd)).toBeCloseTo(0, 9)
    const step = (at: number) => subtract(value[at + 1] ?? X, value[at] ?? X)
    expect(apart(step(0), step(1))).toBeCloseTo(0, 9)
    expect(apart(step(0), step(9))).toBeCloseTo(0, 9)
    const back = gridPoints(corners, 4, 3, true).value ?? []
    expect(new Set(back.map(String))).toEqual(new Set(value.map(String)))
  })
})

it('needs no end of a row or column that has one place', () => {
  const first: Vector = [0.1, 0.2, 0.3]
  expect(gridPoints({ first, rowEnd: first, columnEnd: first }, 1, 1).value).toEqual([first])
  expect(gridPoints({ first, rowEnd: first, columnEnd: first }, 2, 1).fault).toBe('the end of the row is at the first place')
  expect(gridPoints({ first, rowEnd: first, columnEnd: first }, 1, 2).fault).toBe('the end of the column is at the first place')
  expect(gridPoints({ first, rowEnd: [1, 0, 0], columnEnd: first }, 1.5, 1).fault).toBe('columns and rows are whole numbers from 1')
  expect(gridPoints({ first: [0, 0, 0], rowEnd: [1, 0, 0], columnEnd: [2, 0, 0] }, 2, 2).fault).toBe('the three corners are on one line')
})

it('makes of two corners the same box, whichever is given first', () => {
  expect(boxOf([1, 0, 3], [0, 2, 1])).toEqual([
    [0, 0, 1],
    [1, 2, 3],
  ])
  sampled((vector) => {
    const [a, b] = [vector(), vector()]
    expect(boxOf(a, b)).toEqual(boxOf(b, a))
  })
})

it('reads poses and vectors only where all their numbers are there', () => {
  expect(poseFrom([1, 2, 3, 0, 0, 0, 1])).toEqual({ xyz: [1, 2, 3], xyzw: [0, 0, 0, 1] })
  expect(poseFrom([1, 2, 3, 0])).toBeUndefined()
  expect(poseFrom(undefined)).toBeUndefined()
  expect(vectorFrom([1, 2, 3])).toEqual([1, 2, 3])
  expect([vectorFrom([1, 2]), vectorFrom('x'), vectorFrom([1, '${y}', 3])]).toEqual([undefined, undefined, undefined])
  expect(roundedTo([0.12345, -0.00001])).toEqual([0.1235, 0])
})

it('tells the angle at a corner, whichever of its sides is longer', () => {
  expect(angleAt([1, 0, 0], [3, 0, 0], [1, 0, 0.5])).toBeCloseTo(Math.PI / 2)
  expect(angleAt([0, 0, 0], [1, 0, 0], [-2, 0, 0])).toBeCloseTo(Math.PI)
})

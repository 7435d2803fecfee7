/** Lists of waypoints: what they are in words and in the view, with other blends and in another order. */
import { expect, it } from 'vitest'
import { editFieldOf } from './fields'
import {
  blendOf,
  entryWaypoint,
  ghostOf,
  jointWaypoint,
  poseWaypoint,
  waypointsFault,
  waypointsOf,
  waypointWords,
  withBlend,
} from './waypoints'
import { reordered } from '../reorder'
import { wizardOf } from './wizards'

const LIST = [
  { joints: [0.5, -0.25] },
  { pose: { xyz: [0.1, 0.2, 0.3], frame: 'left/base' }, blend_m: 0.1 },
  { pose: { entry: 'above' } },
  { joints: ['${a}', 1] },
  '${last}',
]

it('says what each waypoint is, and shows where the arm would be', () => {
  const waypoints = waypointsOf(LIST)
  expect(waypoints.map(waypointWords)).toEqual([
    'joints 0.50, -0.25',
    'pose 0.100, 0.200, 0.300 m in left/base',
    'above',
    'joints ${a}, 1.00',
    '${last}',
  ])
  expect(waypoints.map(ghostOf)).toEqual([
    { kind: 'joints', name: '', value: { joints: [0.5, -0.25] } },
    { kind: 'pose', name: '', value: { xyz: [0.1, 0.2, 0.3], xyzw: [0, 0, 0, 1], frame: 'left/base' } },
    { kind: 'pose', name: 'above', value: null },
    undefined,
    undefined,
  ])
  expect(waypoints.map(({ value }) => value)).toEqual(LIST)
})

it('knows the place of a pose in the world, and of joints that are taken now', () => {
  expect(waypointsOf([{ pose: { xyz: [1, 2, 3] } }, LIST[1], LIST[0]]).map(({ place }) => place)).toEqual([[1, 2, 3], undefined, undefined])
  const tool = { xyz: [0.5, 0.1, 0.30004], xyzw: [1, 0, 0, 0] } as const
  expect(jointWaypoint([0.50001, 1], tool)).toEqual({ value: { joints: [0.5, 1] }, place: tool.xyz })
  expect(poseWaypoint(tool).value).toEqual({ pose: { xyz: [0.5, 0.1, 0.3], xyzw: [1, 0, 0, 0] } })
  expect(entryWaypoint('pose', 'above').value).toEqual({ pose: { entry: 'above' } })
})

it('gives a waypoint a blend of its own, and takes it away', () => {
  const [first] = waypointsOf(LIST)
  if (!first) throw new Error('there is none')
  const blended = withBlend(first, 0)
  expect([blended.value, blendOf(blended)]).toEqual([{ joints: [0.5, -0.25], blend_m: 0 }, 0])
  expect(withBlend(blended, undefined).value).toEqual(LIST[0])
  expect(blendOf(first)).toBeUndefined()
})

it('moves a waypoint, but not over the ends', () => {
  const waypoints = waypointsOf(LIST.slice(0, 3))
  const order = (list: typeof waypoints) => list.map((each) => waypoints.indexOf(each))
  expect([
    order(reordered(waypoints, 0, 1)),
    order(reordered(waypoints, 2, -1)),
    order(reordered(waypoints, 0, -1)),
    order(reordered(waypoints, 2, 1)),
  ]).toEqual([
    [1, 0, 2],
    [0, 2, 1],
    [0, 1, 2],
    [0, 1, 2],
  ])
})

it('finds lists without waypoints and joints of another arm', () => {
  expect(waypointsFault(waypointsOf('${list}'), 2)).toBe('Add the first waypoint')
  expect(waypointsFault(waypointsOf(LIST), 2)).toBeUndefined()
  expect(waypointsFault(waypointsOf(LIST), undefined)).toBeUndefined()
  expect(waypointsFault(waypointsOf(LIST), 7)).toMatch(/^Waypoint 0 /)
})

it('is what the type of a list of waypoints is taught with', () => {
  const number = { type: 'number' }
  const target = {
    type: 'object',
    properties: { entry: { type: 'string', entry: 'pose' }, xyz: { type: 'array', prefixItems: [number, number, number] }, xyzw: {} },
  }
  const joints = { anyOf: [{ type: 'array', items: number, joints_of: 'robot' }, { type: 'null' }] }
  const waypoint = {
    type: 'object',
    properties: { joints, pose: { anyOf: [{ $ref: '#/$defs/Target' }, { type: 'null' }] }, blend_m: number },
  }
  const schema = { $defs: { Target: target, Waypoint: waypoint }, type: 'array', items: { $ref: '#/$defs/Waypoint' } }
  const field = editFieldOf({ name: 'waypoints', required: true, default: null, schema })
  expect([field.kind, wizardOf(field)]).toEqual(['list', 'waypoints'])
  expect(wizardOf(editFieldOf({ name: 'x', required: true, default: null, schema: { type: 'array', items: target } }))).toBeUndefined()
})

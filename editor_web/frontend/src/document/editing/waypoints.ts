/** A list of waypoints while it is taught: what each is, in words and in the view, and with another blend. Pure. */
import { fieldsOf, lookup, without, type Dict } from '../dict'
import { frameOf, roundedTo, vectorFrom, WORLD, type PlacedPose, type Vector } from '../poses'
import { plainText } from '../values'
import { isTemplate } from './fields'
import { entryNamed } from './preview'

/** A waypoint as the document has it, an expression too, and where its tool is if that is known. */
export interface Waypoint {
  readonly value: unknown
  readonly place: Vector | undefined
}

const TURN_DIGITS = 5

/** The waypoints of a document's value. */
export function waypointsOf(value: unknown): readonly Waypoint[] {
  if (!Array.isArray(value)) return []
  return value.map((each: unknown) => ({ value: each, place: placeOf(each) }))
}

/** A waypoint of the joints that the arm has now. */
export function jointWaypoint(joints: readonly number[], tool: PlacedPose | undefined): Waypoint {
  return { value: { joints: roundedTo(joints) }, place: tool?.xyz }
}

/** A waypoint of the pose that the tool has now. */
export function poseWaypoint({ xyz, xyzw }: PlacedPose): Waypoint {
  return { value: { pose: { xyz: roundedTo(xyz), xyzw: roundedTo(xyzw, TURN_DIGITS) } }, place: xyz }
}

/** A waypoint that an entry names. */
export function entryWaypoint(kind: string, name: string): Waypoint {
  return { value: { [kind]: { entry: name } }, place: undefined }
}

/** A waypoint with a distance of its own; undefined for that of the state. */
export function withBlend(waypoint: Waypoint, blend: number | undefined): Waypoint {
  const fields = fieldsOf(waypoint.value)
  return { ...waypoint, value: blend === undefined ? without(fields, 'blend_m') : { ...fields, blend_m: blend } }
}

/** The distance of its own; undefined where it has none, or one that is an expression. */
export function blendOf({ value }: Waypoint): number | undefined {
  const blend = lookup(fieldsOf(value), 'blend_m')
  return typeof blend === 'number' ? blend : undefined
}

/** Whether it has fields, such as a distance of its own. */
export function hasFields({ value }: Waypoint): boolean {
  return targetOf(value) !== undefined
}

/** What a waypoint is, in a few words. */
export function waypointWords({ value }: Waypoint): string {
  const target = targetOf(value)?.target
  const entry = entryNamed(target)
  if (entry !== undefined) return entry
  if (Array.isArray(target))
    return `joints ${target.map((each) => (typeof each === 'number' ? each.toFixed(2) : plainText(each))).join(', ')}`
  const xyz = vectorFrom(lookup(fieldsOf(target), 'xyz'))
  if (!xyz) return plainText(value)
  const frame = frameOf(target)
  return `pose ${xyz.map((each) => each.toFixed(3)).join(', ')} m${frame === WORLD ? '' : ` in ${frame}`}`
}

/** What shows an arm at a waypoint: an entry by its name, or the fields of one; undefined where only a run knows. */
export function ghostOf({ value }: Waypoint): { kind: string; name: string; value: Dict<unknown> | null } | undefined {
  const { kind, target } = targetOf(value) ?? {}
  if (kind === undefined) return undefined
  const name = entryNamed(target)
  if (name !== undefined) return isTemplate(name) ? undefined : { kind, name, value: null }
  if (Array.isArray(target))
    return target.every((each) => typeof each === 'number') ? { kind, name: '', value: { joints: target } } : undefined
  const xyz = vectorFrom(lookup(fieldsOf(target), 'xyz'))
  const xyzw = lookup(fieldsOf(target), 'xyzw') ?? [0, 0, 0, 1]
  return xyz && { kind, name: '', value: { xyz, xyzw, frame: frameOf(target) } }
}

/** Why the waypoints cannot be used for an arm with so many joints. */
export function waypointsFault(waypoints: readonly Waypoint[], joints: number | undefined): string | undefined {
  if (waypoints.length === 0) return 'Add the first waypoint'
  const at = waypoints.findIndex(({ value }) => {
    const given = lookup(fieldsOf(value), 'joints')
    return joints !== undefined && Array.isArray(given) && given.length !== joints
  })
  return at < 0 ? undefined : `Waypoint ${at} has not as many joints as the arm, ${joints}: take it anew`
}

function placeOf(value: unknown): Vector | undefined {
  const pose = lookup(fieldsOf(value), 'pose')
  return frameOf(pose) === WORLD ? vectorFrom(lookup(fieldsOf(pose), 'xyz')) : undefined
}

function targetOf(value: unknown): { readonly kind: 'joints' | 'pose'; readonly target: unknown } | undefined {
  const fields = fieldsOf(value)
  const kind = 'joints' in fields ? 'joints' : 'pose' in fields ? 'pose' : undefined
  return kind && { kind, target: fields[kind] }
}

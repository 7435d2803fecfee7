/** An item that is dragged in the 3D view: the numbers of its form, snapped to steps and to connectors. Pure. */
import type { CellDraft, DraftItem } from '../api/types'
import { valueAt, withValue, type Section } from './cellFields'
import { frameOf, placeKey } from './cellShown'
import { fieldsOf, lookup, type Dict } from './dict'
import { distance, poseFrom, roundedTo, seenFrom, vectorFrom, type PlacedPose, type Vector } from './poses'
import { rollPitchYaw } from './teaching'

export type DragSteps = 'off' | 'fine' | 'usual' | 'coarse'

/** A drag ends at whole steps: metres and radians. */
export const DRAG_STEPS: Readonly<Record<Exclude<DragSteps, 'off'>, { readonly label: string; readonly m: number; readonly rad: number }>> =
  {
    fine: { label: '1 mm, 1°', m: 0.001, rad: Math.PI / 180 },
    usual: { label: '10 mm, 15°', m: 0.01, rad: Math.PI / 12 },
    coarse: { label: '50 mm, 45°', m: 0.05, rad: Math.PI / 4 },
  }

/** So near to a connector an item is put onto it. */
export const CONNECTOR_M = 0.03

const FIXED: ReadonlySet<Section> = new Set(['modules', 'equipment', 'devices', 'bonds'])

/** Can it be dragged? A module stands where its connector is, a device and a bond where their bodies are. */
export function canDrag(section: Section): boolean {
  return !FIXED.has(section)
}

/** Can it be turned? A camera looks at a point. */
export function canTurn(section: Section): boolean {
  return canDrag(section) && section !== 'cameras'
}

/** The value of an item whose origin is dragged to a pose of the world; the same value where nobody knows what it stands in. */
export function draggedTo(
  { section, name, value }: Pick<DraftItem, 'section' | 'name' | 'value'>,
  pose: PlacedPose,
  { frames, items }: Pick<CellDraft, 'frames' | 'items'>,
  steps: Exclude<DragSteps, 'off'>,
): Dict<unknown> {
  const base = lookup(frames, frameOf(section, value))
  if (!base) return value
  const connector = items
    .filter((each) => each.section === 'connectors' && each.name !== name)
    .map((each) => lookup(frames, each.name))
    .find((each) => each !== undefined && distance(each.xyz, pose.xyz) < CONNECTOR_M)
  const seen = seenFrom(connector ?? pose, base)
  const { m, rad } = DRAG_STEPS[steps]
  const stepped = (values: Vector, step: number): Vector =>
    connector ? roundedTo(values, 6) : roundedTo([stepTo(values[0], step), stepTo(values[1], step), stepTo(values[2], step)] as const, 6)
  const moved = withValue(value, section === 'cameras' ? ['at'] : [placeKey(section), 'xyz'], stepped(seen.xyz, m))
  if (!canTurn(section)) return moved
  const turn = stepped(rollPitchYaw(seen.xyzw), rad)
  const path = [placeKey(section), 'rpy']
  const isWritten = valueAt(value, path) !== undefined
  return isWritten || turn.some((each) => each !== 0) ? withValue(moved, path, turn) : moved
}

/** The pose that a wizard has made; undefined where it is none. */
export function taughtPose(made: unknown): PlacedPose | undefined {
  const xyz = vectorFrom(lookup(fieldsOf(made), 'xyz'))
  const turn = lookup(fieldsOf(made), 'xyzw')
  return xyz && Array.isArray(turn) ? poseFrom([...xyz, ...(turn as number[])]) : undefined
}

/** The value of an item whose origin is taught at a pose of the world; the same value where nobody knows what it stands in. */
export function taughtAt(
  { section, value }: Pick<DraftItem, 'section' | 'value'>,
  pose: PlacedPose,
  { frames }: Pick<CellDraft, 'frames'>,
): Dict<unknown> {
  const base = lookup(frames, frameOf(section, value))
  if (!base) return value
  const seen = seenFrom(pose, base)
  const moved = withValue(value, [placeKey(section), 'xyz'], roundedTo(seen.xyz, 6))
  return withValue(moved, [placeKey(section), 'rpy'], roundedTo(rollPitchYaw(seen.xyzw), 6))
}

function stepTo(value: number, step: number): number {
  return Math.round(value / step) * step
}

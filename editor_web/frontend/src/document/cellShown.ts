/** Where an item under edit is in the 3D view, before anything is applied. Pure. */
import type { CellDraft } from '../api/types'
import { axisEnd } from './cellDevices'
import { sizeNames } from './cellEditing'
import { numbersOf, valueAt, type Section } from './cellFields'
import { fieldsOf, lookup, type Dict } from './dict'
import { inWorld, NO_TURN, turnOf, vectorFrom, WORLD, type PlacedPose, type Vector } from './poses'

/** A body or axes as the 3D view shows them before anything is applied. */
export interface ShownItem {
  readonly pose: PlacedPose
  readonly shape: 'box' | 'cylinder' | 'sphere' | undefined
  readonly size: readonly number[]
}

/**
 * Where an item with this value is in the world; undefined where nobody can tell. Of a device it is the fixture of an
 * axis at the end of its stroke, of a bond its place.
 */
export function shownItem(
  section: Section,
  value: Dict<unknown>,
  draft: Pick<CellDraft, 'frames' | 'parts' | 'items'>,
  axis = '',
): ShownItem | undefined {
  const { frames } = draft
  if (section === 'devices') {
    const end = axisEnd(value, axis, draft)
    return end && { ...bodyOf(end.fixture ?? {}, end.pose) }
  }
  if (section === 'bonds') {
    const part = lookup(draft.parts, frameOf(section, value))
    const at = vectorFrom(lookup(value, 'at_m')) ?? [0, 0, 0]
    return part && { pose: inWorld({ xyz: at, xyzw: NO_TURN }, part), shape: undefined, size: [] }
  }
  const isCamera = section === 'cameras'
  const at = isCamera ? value : fieldsOf(lookup(value, placeKey(section)))
  const base = lookup(frames, frameOf(section, value))
  if (!base) return undefined
  const xyz: Vector = vectorFrom(lookup(at, isCamera ? 'at' : 'xyz')) ?? [0, 0, 0]
  const rpy = vectorFrom(lookup(at, 'rpy'))
  const place = { xyz: base.xyz, xyzw: base.xyzw }
  return bodyOf(value, inWorld({ xyz, xyzw: rpy ? turnOf(rpy) : NO_TURN }, place))
}

function bodyOf(value: Dict<unknown>, pose: PlacedPose): ShownItem {
  const shape = lookup(value, 'shape')
  const size = numbersOf(lookup(value, 'size_m'))
  if (size.length !== sizeNames(shape).length || size.some((each) => each <= 0)) return { pose, shape: undefined, size: [] }
  // The place of a tray is the middle of its underside.
  if (shape === 'tray') return { pose: inWorld({ xyz: [0, 0, (size[2] ?? 0) / 2], xyzw: NO_TURN }, pose), shape: 'box', size }
  return { pose, shape: shape === 'box' || shape === 'cylinder' || shape === 'sphere' ? shape : undefined, size }
}

/** The field in which an item has its place. */
export function placeKey(section: Section): 'at' | 'base' {
  return section === 'robots' ? 'base' : 'at'
}

/** The name of what an item stands in. */
export function frameOf(section: Section, value: Dict<unknown>): string {
  const paths: Readonly<Record<Section, readonly string[]>> = {
    robots: ['base', 'frame'],
    fixtures: ['at', 'frame'],
    parts: ['at', 'frame'],
    cameras: ['frame'],
    frames: ['parent'],
    connectors: ['parent'],
    modules: ['connector'],
    equipment: [],
    devices: [],
    bonds: ['part'],
  }
  const written = valueAt(value, paths[section])
  // A module that is plugged later may name no connector yet.
  return typeof written === 'string' ? written : section === 'modules' ? '' : WORLD
}

/** The distance and the turn from one item of a cell to another. Pure. */
import type { CellDraft, CellStateFrame } from '../api/types'
import { placeOf, poseOf, type CellNode } from './cellTree'
import { itemAt } from './cellEditing'
import { shownItem } from './cellShown'
import { lookup } from './dict'
import { distance, inverted, multiplied, seenFrom, subtract, type PlacedPose, type Vector } from './poses'

export interface Measured {
  readonly distance_m: number
  /** From the first to the second, along the axes of the world and along those of the first. */
  readonly world_m: Vector
  readonly own_m: Vector
  /** By how much the second is turned. */
  readonly angle_rad: number
}

export function measuredBetween(from: PlacedPose, to: PlacedPose): Measured {
  const [x, y, z, w] = multiplied(inverted(from.xyzw), to.xyzw)
  return {
    distance_m: distance(from.xyz, to.xyz),
    world_m: subtract(to.xyz, from.xyz),
    own_m: seenFrom(to, from).xyz,
    angle_rad: 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w)),
  }
}

/** Where an item is in the world: in the document under edit, else in the cell as it is now. */
export function placeToMeasure(node: CellNode, draft: CellDraft | undefined, state: CellStateFrame | undefined): PlacedPose | undefined {
  const item = draft && itemAt(draft, node.address)
  if (draft && item) return shownItem(item.section, item.value, draft)?.pose
  const name = placeOf(node) ?? node.item?.name ?? ''
  const drafted = draft && (lookup(draft.frames, name) ?? lookup(draft.parts, name))
  return drafted ?? poseOf(node, state)
}

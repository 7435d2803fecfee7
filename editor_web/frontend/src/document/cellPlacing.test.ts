/** Dragging in 3D: numbers in the frame that an item stands in, at whole steps, or on a connector. */
import { expect, it } from 'vitest'
import type { DraftItem } from '../api/types'
import { canDrag, canTurn, draggedTo, taughtAt, taughtPose } from './cellPlacing'
import { turnOf } from './poses'

const STRAIGHT = [0, 0, 0, 1] as const
const QUARTER = Math.PI / 2

function item(section: DraftItem['section'], value = {}): DraftItem {
  return { section, name: 'it', value, line: 1, end_line: 1 }
}

const dock: DraftItem = { ...item('connectors'), name: 'dock' }
const draft = {
  items: [dock],
  frames: {
    world: { xyz: [0, 0, 0] as const, xyzw: STRAIGHT, frame: 'world' },
    table: { xyz: [1, 0, 0] as const, xyzw: turnOf([0, 0, QUARTER]), frame: 'world' },
    dock: { xyz: [2, 0.1234, 0] as const, xyzw: turnOf([0, 0, QUARTER]), frame: 'world' },
  },
}

it('puts an item to the nearest step of the frame that it stands in', () => {
  const box = item('fixtures', { shape: 'box', at: { frame: 'table' } })
  const at = { xyz: [1.004, 0.526, -0.3] as const, xyzw: turnOf([0, 0, QUARTER + 0.3]) }
  expect(draggedTo(box, at, draft, 'usual')).toEqual({ shape: 'box', at: { frame: 'table', xyz: [0.53, 0, -0.3], rpy: [0, 0, 0.261799] } })
  expect(draggedTo(box, at, draft, 'fine')).toMatchObject({ at: { xyz: [0.526, -0.004, -0.3] } })
  expect(draggedTo(box, at, draft, 'coarse')).toEqual({ shape: 'box', at: { frame: 'table', xyz: [0.55, 0, -0.3] } })
})

it('puts it onto a connector that is near, exactly, and on no connector onto itself', () => {
  const near = { xyz: [2.01, 0.13, 0.01] as const, xyzw: STRAIGHT }
  expect(draggedTo(item('frames'), near, draft, 'coarse')).toEqual({ at: { xyz: [2, 0.1234, 0], rpy: [0, 0, 1.570796] } })
  expect(draggedTo(dock, near, draft, 'usual')).toEqual({ at: { xyz: [2.01, 0.13, 0.01] } })
})

it('moves a camera and turns it not, and leaves what stands in something unknown', () => {
  const at = { xyz: [0.3, 0, 1] as const, xyzw: turnOf([0, 0, 1]) }
  expect(draggedTo(item('cameras', { at: [0, 0, 2] }), at, draft, 'fine')).toEqual({ at: [0.3, 0, 1] })
  const lost = { at: { frame: 'nowhere' } }
  expect(draggedTo(item('parts', lost), at, draft, 'fine')).toBe(lost)
  expect([canTurn('cameras'), canDrag('cameras'), canDrag('modules')]).toEqual([false, true, false])
})

it('takes a pose that an arm has taught, in what the item stands in', () => {
  const slot = item('frames', { parent: 'table' })
  const taught = taughtPose({ xyz: [1, 0.52345678, 0], xyzw: turnOf([0, 0, QUARTER + 0.3]) })
  expect(taught && taughtAt(slot, taught, draft)).toEqual({ parent: 'table', at: { xyz: [0.523457, 0, 0], rpy: [0, 0, 0.3] } })
  expect(taught && taughtAt(item('frames', { parent: 'nowhere' }), taught, draft)).toEqual({ parent: 'nowhere' })
  expect(taughtPose({ xyz: [1, 2] })).toBeUndefined()
})

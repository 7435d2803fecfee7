/** Measuring between two items: distance, its parts along the axes of the world and of the first, and the angle. */
import { expect, it } from 'vitest'
import type { CellDraft } from '../api/types'
import { measuredBetween, placeToMeasure } from './cellMeasure'
import type { CellNode } from './cellTree'
import { turnOf } from './poses'

const QUARTER = Math.PI / 2

it('measures along the axes of the world and along those of the first', () => {
  const from = { xyz: [1, 0, 0] as const, xyzw: turnOf([0, 0, QUARTER]) }
  const found = measuredBetween(from, { xyz: [1, 3, 4], xyzw: turnOf([0, 0, -QUARTER]) })
  expect(found.distance_m).toBe(5)
  expect(found.world_m).toEqual([0, 3, 4])
  found.own_m.forEach((each, at) => expect(each).toBeCloseTo([3, 0, 4][at] ?? 0))
  expect(found.angle_rad).toBeCloseTo(Math.PI)
})

it('is the same turn in both directions, and none for two of one kind', () => {
  const [a, b] = [turnOf([0.3, 0, 0]), turnOf([-0.2, 0, 0])]
  const at = (xyzw: typeof a) => ({ xyz: [0, 0, 0] as const, xyzw })
  expect(measuredBetween(at(a), at(b)).angle_rad).toBeCloseTo(0.5)
  expect(measuredBetween(at(b), at(a)).angle_rad).toBeCloseTo(0.5)
  const [x, y, z, w] = a
  expect(measuredBetween(at(a), at([-x, -y, -z, -w])).angle_rad).toBeCloseTo(0)
})

it('takes the place of the draft before that of the open cell', () => {
  const pose = (x: number) => ({ xyz: [x, 0, 0] as const, xyzw: [0, 0, 0, 1] as const, frame: 'world' })
  const node: CellNode = { address: 'fixtures/vice/jaw', kind: 'fixture', name: 'jaw', detail: '', item: undefined, children: [] }
  const part: CellNode = { ...node, address: 'parts/vice/lid', kind: 'part', item: item('parts/vice/lid', 'vice/lid') }
  const draft: CellDraft = {
    text: '',
    hash: '',
    kind: 'cell',
    items: [{ section: 'fixtures', name: 'table', line: 1, end_line: 1, value: { at: { xyz: [0.5, 0, 0] } } }],
    findings: [],
    frames: { world: pose(0) },
    parts: { 'vice/lid': pose(7) },
    positions: {},
  }
  expect(placeToMeasure({ ...node, address: 'fixtures/table' }, draft, undefined)?.xyz).toEqual([0.5, 0, 0])
  expect(placeToMeasure(part, draft, undefined)?.xyz).toEqual([7, 0, 0])
  expect(placeToMeasure(node, undefined, undefined)).toBeUndefined()
})

function item(path: string, name: string) {
  return { path, kind: 'part' as const, name, model: '', owner: '', topics: [], text: '', line: 1, file: '' }
}

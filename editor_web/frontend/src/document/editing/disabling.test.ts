import { expect, it } from 'vitest'
import { disabling, isPassedOver, passing } from './disabling'
import { machineNode, node } from './testNodes'

const GRASP = node('root/grasp', ['failed', 'missed', 'held'], { targets: { held: 'place', failed: 'bad' } })
const PLACE = node('root/place', ['done'])
const LEAF = node('root/tree/sequence/look', ['seen'])
const TREE = node('root/tree', ['success', 'failure'], {
  kind: 'tree',
  children: [node('root/tree/sequence', [], { kind: 'sequence', children: [LEAF] })],
})
const ROOT = machineNode('root', 'grasp', [GRASP, PLACE, TREE], [])

it('passes a node with a connected outcome that is no failure, and a part of a tree without one', () => {
  expect(passing(ROOT, GRASP)).toBe('held')
  expect(passing(ROOT, PLACE)).toBe('done')
  expect(passing(ROOT, LEAF)).toBe(true)
  expect(passing(ROOT, node('root/new', []))).toBeUndefined()
})

it('disables several at once, and enables them where all are disabled', () => {
  const both = ['root/grasp', 'root/tree/sequence/look']
  expect(disabling(ROOT, both).edits).toEqual([
    { edit: 'set_field', path: 'root/grasp', field: 'disabled', value: 'held' },
    { edit: 'set_field', path: 'root/tree/sequence/look', field: 'disabled', value: true },
  ])
  const off = { ...ROOT, children: [{ ...GRASP, disabled: 'held' }, PLACE, TREE] }
  expect(disabling(off, both).edits).toHaveLength(1)
  expect(disabling(off, ['root/grasp'])).toEqual({
    edits: [{ edit: 'set_field', path: 'root/grasp', field: 'disabled', value: null }],
    isEnabling: true,
    obstacle: undefined,
  })
})

it('says why it does nothing', () => {
  expect(disabling(ROOT, ['root']).obstacle).toContain('as a whole')
  const bare = { ...ROOT, children: [node('root/new', [])] }
  expect(disabling(bare, ['root/new']).obstacle).toContain('new has no outcome')
})

it('greys what is inside a disabled container', () => {
  const off = { ...ROOT, children: [GRASP, PLACE, { ...TREE, disabled: 'success' }] }
  expect(isPassedOver(off, LEAF.path)).toBe(true)
  expect(isPassedOver(off, 'root/grasp')).toBe(false)
})

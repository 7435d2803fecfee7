import { expect, test } from 'vitest'
import { setField } from './edits'
import { areOfLayout, withLayout } from './layoutEdits'
import { nodeOf } from './model'
import { machineNode, node } from './testNodes'

const root = machineNode('root', 'a', [node('root/a', ['done'], { position: [1, 1] }), node('root/b', ['done'])], [])

test('positions and notes mean nothing to a run, everything else may', () => {
  expect(areOfLayout([{ edit: 'set_positions', positions: {} }, setField('root/a', 'notes', 'x')])).toBe(true)
  expect(areOfLayout([setField('root/a', 'description', 'x')])).toBe(false)
  expect(areOfLayout([])).toBe(false)
})

test('positions are set and taken away, and notes written, on the nodes that they name', () => {
  const made = withLayout(root, [
    { edit: 'set_positions', positions: { 'root/a': null, 'root/b': [3, 4], 'root/gone': [5, 6] } },
    setField('root/b', 'notes', 'mind the gap'),
    setField('root', 'notes', null),
  ])
  expect(nodeOf(made, 'root/a')?.position).toBeNull()
  expect(nodeOf(made, 'root/b')).toMatchObject({ position: [3, 4], notes: 'mind the gap' })
  expect(root.children[1]?.position).toBeNull()
})

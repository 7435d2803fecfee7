import { expect, test } from 'vitest'
import { inlineReferences, enclosingReference } from './referenceInlining'
import { allNodes } from './model'
import { nodeAtLine } from './textPositions'
import { machineNode, node } from './testNodes'

const INNER = machineNode('root', 'wait', [node('root/wait', ['done'], { line: 8, end_line: 9 })], [['wait', 'done', 'good']])
const NAP = node('root/box/nap', ['good'], { kind: 'behavior', document: 'behaviors/nap.yaml', line: 4, end_line: 6 })
const OUTER = machineNode('root', 'box', [machineNode('root/box', 'nap', [NAP], []), node('root/last', ['done'])], [])

test('what is inside a reference stands below it under its own path', () => {
  const seen = inlineReferences(OUTER, new Map([['behaviors/nap.yaml', INNER]]))
  expect(allNodes(seen).map((each) => each.path)).toEqual([
    'root',
    'root/box',
    'root/box/nap',
    'root/box/nap/root',
    'root/box/nap/root/wait',
    'root/last',
  ])
})

test('what does not change stays the same object', () => {
  const bodies = new Map([['behaviors/nap.yaml', INNER]])
  const once = inlineReferences(OUTER, bodies)
  expect(inlineReferences(once, bodies)).toBe(once)
  expect(once.children[1]).toBe(OUTER.children[1])
  expect(inlineReferences(OUTER, new Map())).toBe(OUTER)
})

test('a body that was read anew takes the place of the one before', () => {
  const once = inlineReferences(OUTER, new Map([['behaviors/nap.yaml', INNER]]))
  const other = machineNode('root', 'sleep', [node('root/sleep', ['done'])], [])
  const again = inlineReferences(once, new Map([['behaviors/nap.yaml', other]]))
  expect(allNodes(again).map((each) => each.name)).toContain('sleep')
  expect(allNodes(again).map((each) => each.name)).not.toContain('wait')
})

test('behaviors that refer to each other in a circle come to an end', () => {
  const circle = machineNode('root', 'again', [node('root/again', [], { kind: 'behavior', document: 'x' })], [])
  expect(allNodes(inlineReferences(circle, new Map([['x', circle]]))).length).toBeLessThan(60)
})

test('no line of this text belongs to what stands in another one', () => {
  const seen = inlineReferences(OUTER, new Map([['behaviors/nap.yaml', INNER]]))
  expect(nodeAtLine(seen, 5)?.path).toBe('root/box/nap')
  expect(nodeAtLine(seen, 8)?.path).not.toBe('root/box/nap/root/wait')
})

test('a node of another document is found there', () => {
  const seen = inlineReferences(OUTER, new Map([['behaviors/nap.yaml', INNER]]))
  const place = enclosingReference(seen, 'root/box/nap/root/wait')
  expect([place?.reference.path, place?.inner]).toEqual(['root/box/nap', 'root/wait'])
  expect(enclosingReference(seen, 'root/box/nap')).toBeUndefined()
})

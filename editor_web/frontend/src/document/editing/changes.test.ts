import { expect, test } from 'vitest'
import { containersOfMarks, markingsOf, meaningful, wordsOfChange } from './changes'
import type { NodeChange } from '../../api/types'
import { machineNode, node } from './testNodes'

const changed = (path: string, change: NodeChange['change'], more = {}): NodeChange => ({
  path,
  change,
  before_path: null,
  fields: [],
  ...more,
})

test('a change is said in words', () => {
  expect(wordsOfChange(changed('root/box/grasp', 'added')).title).toBe('grasp added in box')
  expect(wordsOfChange(changed('root/grasp', 'removed')).title).toBe('grasp removed')
  expect(wordsOfChange(changed('root/take', 'moved', { before_path: 'root/grasp' })).title).toBe('grasp renamed to take')
  expect(wordsOfChange(changed('root/box/grasp', 'moved', { before_path: 'root/grasp' })).title).toBe('grasp moved into box')
  const fields = [
    { field: 'with.speed', before: 1, after: 2 },
    { field: 'timeout', before: null, after: { after: 3 } },
    { field: 'notes', before: 'old', after: null },
  ]
  expect(wordsOfChange(changed('root/grasp', 'changed', { fields })).lines).toEqual([
    'speed: 1 → 2',
    'timeout: {"after":3}',
    'notes: old taken away',
  ])
})

test('the order of a container counts only where what stays changed places', () => {
  const order = (before: readonly string[], after: readonly string[]) =>
    meaningful([changed('root', 'changed', { fields: [{ field: 'machine.order', before, after }] })])
  expect(order(['a', 'b'], ['a', 'new', 'b'])).toEqual([])
  expect(order(['a', 'b', 'c'], ['a', 'c'])).toEqual([])
  expect(order(['a', 'b'], ['b', 'a']).map((each) => wordsOfChange(each).lines)).toEqual([['order: b, a']])
})

test('nodes and arrows are marked in both drawings', () => {
  const before = machineNode(
    'root',
    'a',
    [node('root/a', ['done']), node('root/b', ['done'])],
    [
      ['a', 'done', 'b'],
      ['b', 'done', 'good'],
    ],
  )
  const after = machineNode(
    'root',
    'a',
    [node('root/a', ['done']), node('root/c', ['done'])],
    [
      ['a', 'done', 'c'],
      ['c', 'done', 'good'],
    ],
  )
  const marks = markingsOf([changed('root/b', 'removed'), changed('root/c', 'added')], before, after)
  expect([...marks.before]).toEqual([
    ['root/b', 'removed'],
    ['root|a|done', 'changed'],
    ['root|b|done', 'removed'],
  ])
  expect([...marks.after]).toEqual([
    ['root/c', 'added'],
    ['root|a|done', 'changed'],
    ['root|c|done', 'added'],
  ])
})

test('what is around a mark is open', () => {
  const marks = new Map([
    ['root/box/inner/a', 'added' as const],
    ['root/other|b|done', 'added' as const],
  ])
  expect([...containersOfMarks(marks)].toSorted()).toEqual(['root', 'root/box', 'root/box/inner', 'root/other'])
})

import { expect, test } from 'vitest'
import type { FindingView, GraphDifference } from '../../api/types'
import { shiftedFindings, withDifference } from './graphDifference'
import { nodeOf } from './model'
import { machineNode, node } from './testNodes'

const a = node('root/a', ['done'], { line: 5, end_line: 7 })
const b = node('root/b', ['done'], { line: 8, end_line: 9 })
const root = {
  ...machineNode(
    'root',
    'a',
    [a, b],
    [
      ['a', 'done', 'b'],
      ['b', 'done', 'good'],
    ],
  ),
  line: 2,
  end_line: 9,
}

function difference(more: Partial<GraphDifference>): GraphDifference {
  return { base: 'h', nodes: {}, children: {}, arrows: {}, shifts: [], lines: {}, ...more }
}

test('nothing different leaves the same object', () => {
  expect(withDifference(root, difference({}))).toBe(root)
})

test('a node that says something else is new, and its siblings are the same', () => {
  const said = { ...a, line: 0, column: 0, end_line: 0, parameters: { duration_s: 2 } }
  const made = withDifference(root, difference({ nodes: { 'root/a': said } }))
  expect(nodeOf(made, 'root/a')).toEqual({ ...a, parameters: { duration_s: 2 } })
  expect(nodeOf(made, 'root/b')).toBe(b)
  expect(made?.transitions).toBe(root.transitions)
})

test('a new child comes with its lines and arrows, and moves what is below it', () => {
  const made = withDifference(
    root,
    difference({
      nodes: { 'root/c': { ...node('root/c', ['done']), line: 0 } },
      children: { root: ['a', 'c', 'b'], 'root/c': [] },
      arrows: {
        root: { a: [{ source: 'a', outcome: 'done', target: 'c' }], c: [{ source: 'c', outcome: 'done', target: 'b' }] },
      },
      lines: { 'root/c': [8, 7, 10] },
      shifts: [[8, 3]],
    }),
  )
  expect(made?.children.map((child) => [child.name, child.line, child.end_line])).toEqual([
    ['a', 5, 7],
    ['c', 8, 10],
    ['b', 11, 12],
  ])
  expect(made?.transitions.map((arrow) => `${arrow.source}>${arrow.target}`)).toEqual(['a>c', 'c>b', 'b>good'])
  expect(made?.end_line).toBe(12)
  expect(nodeOf(made, 'root/a')).toBe(a)
})

test('what is gone takes its arrows along', () => {
  const made = withDifference(root, difference({ children: { root: ['a'] }, arrows: { root: { a: [] } } }))
  expect(made?.children).toEqual([a])
  expect(made?.transitions).toEqual([])
})

test('what is shown inside of a reference stays while the reference does', () => {
  const inside = node('root/r/root', ['done'], { line: 8 })
  const reference = node('root/r', ['done'], { kind: 'behavior', document: 'x.yaml', line: 8, children: [inside] })
  const around = { ...root, children: [a, reference] }
  expect(nodeOf(withDifference(around, difference({ shifts: [[20, 1]] })), 'root/r')).toBe(reference)
  expect(nodeOf(withDifference(around, difference({ shifts: [[8, 1]] })), 'root/r')?.children).toEqual([])
})

test('the difference from another graph is told', () => {
  expect(withDifference(root, difference({ children: { root: ['a', 'unknown'] } }))).toBeUndefined()
})

test('findings move with their lines', () => {
  const finding = (line: number) => ({ line, column: 1, path: 'root' }) as FindingView
  const moved = shiftedFindings([finding(3), finding(8)], difference({ shifts: [[8, 2]] }))
  expect(moved.map((each) => each.line)).toEqual([3, 10])
})

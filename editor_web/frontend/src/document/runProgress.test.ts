/** How far a run is. */
import { expect, it } from 'vitest'
import type { GraphNode, NodeLive } from '../api/types'
import { activeLeaves, stripCells, progressText } from './runProgress'
import { pathWords } from './path'

const graph = (path: string, children: readonly GraphNode[] = []): GraphNode => ({
  path,
  name: path.split('/').pop() ?? '',
  kind: children.length > 0 ? 'machine' : 'state',
  icon: 'state',
  title: '',
  description: '',
  outcomes: [],
  children,
  transitions: [],
  initial: null,
  conditions: [],
  disabled: false,
})
const live = (status: string, entered_s = 0): NodeLive => ({
  status,
  visits: 1,
  outcome: '',
  entered_s,
  duration_s: 0,
  cause: '',
  last_transition: '',
  taken: {},
  plan: null,
})
const root = graph('root', [
  graph('root/first'),
  graph('root/both', [graph('root/both/left'), graph('root/both/right')]),
  graph('root/rest'),
])

it('makes a cell of every state, in the order of the document', () => {
  expect(stripCells(root).map((node) => node.path)).toEqual(['root/first', 'root/both/left', 'root/both/right', 'root/rest'])
})

it('stays outside where there are too many inside', () => {
  expect(stripCells(root, 3).map((node) => node.path)).toEqual(['root/first', 'root/both', 'root/rest'])
  expect(stripCells(root, 1).map((node) => node.path)).toEqual(['root'])
  expect(stripCells(graph('root')).map((node) => node.path)).toEqual(['root'])
})

it('names the innermost active nodes, the one that was entered first before the others', () => {
  const nodes = {
    root: live('active'),
    'root/first': live('done'),
    'root/both': live('active', 1),
    'root/both/left': live('active', 3),
    'root/both/right': live('active', 2),
  }
  expect(activeLeaves(nodes)).toEqual(['root/both/right', 'root/both/left'])
  expect(activeLeaves({ root: live('active') })).toEqual(['root'])
  expect(activeLeaves({})).toEqual([])
})

it('says a path without its root', () => {
  expect(pathWords('root/both/left')).toBe('both › left')
  expect(pathWords('root')).toBe('root')
})

it('counts what is done and names what is not well', () => {
  const nodes = { 'root/first': live('done'), 'root/both/left': live('active'), 'root/both/right': live('failed') }
  expect(progressText(stripCells(root), nodes)).toBe('1 of 4 steps done, 1 active, 1 failed')
  expect(progressText(stripCells(root), {})).toBe('0 of 4 steps done')
  expect(progressText(stripCells(root), nodes, ['root/first'])).toBe('0 of 4 steps done, 1 active, 1 waits, 1 failed')
})

/** Folded containers: one box each, everything else as it was. */
import { expect, it } from 'vitest'
import type { GraphNode } from '../api/types'
import { drawnAt, folded, inactive, toggled, unfoldedTo } from './folding'
import { flatten } from './tree'

function graphNode(path: string, told: Partial<GraphNode> = {}): GraphNode {
  return {
    path,
    name: path.split('/').at(-1) ?? path,
    kind: 'state',
    icon: 'state',
    title: 'test.Give',
    description: '',
    outcomes: ['a'],
    children: [],
    transitions: [],
    initial: null,
    conditions: [],
    disabled: false,
    ...told,
  }
}

const GRASP = graphNode('root/left/grasp')
const LEFT = graphNode('root/left', { kind: 'machine', title: '', children: [GRASP, graphNode('root/left/lift')], initial: 'grasp' })
const DEEP = graphNode('root/right/deep', { kind: 'machine', title: '', children: [graphNode('root/right/deep/wait')] })
const RIGHT = graphNode('root/right', { kind: 'concurrency', title: '', children: [DEEP, graphNode('root/right/watch')] })
const ROOT = graphNode('root', { kind: 'machine', title: '', children: [LEFT, RIGHT], initial: 'left' })

it('draws a folded container as one box that tells how much is inside', () => {
  const drawn = folded(ROOT, new Set(['root/right']))
  expect(flatten(drawn).map((node) => node.path)).toEqual(['root', 'root/left', 'root/left/grasp', 'root/left/lift', 'root/right'])
  expect(drawn.children[1]?.title).toBe('Concurrency of 2')
  expect(drawn.children[0]).toBe(LEFT)
  expect(drawn.initial).toBe('left')
})

it('changes nothing where nothing is folded, or no container is', () => {
  expect(folded(ROOT, new Set())).toBe(ROOT)
  expect(folded(ROOT, new Set(['root/left/grasp', 'root/gone']))).toBe(ROOT)
})

it('knows what stands for a node, and how to show it', () => {
  const paths = new Set(['root/right', 'root/right/deep', 'root/left'])
  expect(drawnAt('root/right/deep/wait', paths)).toBe('root/right')
  expect(drawnAt('root/right', paths)).toBe('root/right')
  expect([...unfoldedTo('root/right/deep/wait', paths)]).toEqual(['root/left'])
  expect([...toggled('root/left', paths)]).toEqual(['root/right', 'root/right/deep'])
  expect([...toggled('root', new Set())]).toEqual(['root'])
})

it('finds what has nothing active in it', () => {
  const active = (...paths: string[]) => inactive(ROOT, (path) => paths.includes(path))
  expect(active('root/left/grasp')).toEqual(['root/right'])
  expect(active('root/right/watch')).toEqual(['root/left', 'root/right/deep'])
  expect(active('root/left/lift', 'root/right/deep/wait')).toEqual([])
  expect(active()).toEqual([])
})

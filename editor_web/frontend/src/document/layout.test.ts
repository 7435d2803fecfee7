/** Layout: nothing overlaps, nothing leaves its container, every arrow is drawn or written on its state. */
import { describe, expect, it } from 'vitest'
import type { GraphNode } from '../api/types'
import { chainOf } from './chain'
import { roundedPath } from './geometry'
import type { LayoutCall } from './elkGraph'
import { drawnOutcomes, exitsOf, layOut } from './layout'

const noCall: LayoutCall = () => Promise.reject(new Error('a straight machine needs no layout engine'))

function leaf(path: string): GraphNode {
  const name = path.split('/').pop() ?? ''
  return {
    path,
    name,
    kind: 'state',
    icon: 'state',
    title: 'motion.MoveJoints',
    description: '',
    outcomes: ['done', 'failed'],
    children: [],
    transitions: [],
    initial: null,
    conditions: [],
    disabled: false,
  }
}

function straight(path: string, names: readonly string[]): GraphNode {
  const children = names.map((name) => leaf(`${path}/${name}`))
  const transitions = names.flatMap((name, index) => [
    { source: name, outcome: 'done', target: names[index + 1] ?? 'finished' },
    { source: name, outcome: 'failed', target: 'failed' },
  ])
  return { ...leaf(path), kind: 'machine', title: '', outcomes: ['finished', 'failed'], children, transitions, initial: names[0] ?? null }
}

const machine = straight('root', ['a', 'b', 'c', 'd', 'e', 'f'])

describe('drawnOutcomes', () => {
  it('draws the outcome that one arrow leads to, and writes the others on the states', () => {
    expect(drawnOutcomes(machine)).toEqual(['finished'])
    expect(exitsOf(machine, 'b')).toEqual([{ source: 'b', outcome: 'failed', target: 'failed' }])
  })
})

describe('chainOf', () => {
  const flow = { order: ['a', 'b', 'c', 'd', 'e', 'f'], loose: [] }

  it('gives up on a branch', () => {
    const branch = [...machine.transitions, { source: 'a', outcome: 'again', target: 'c' }]
    expect(
      chainOf(
        flow,
        branch.filter((t) => t.target !== 'failed'),
        ['finished'],
      ),
    ).toBeUndefined()
  })

  it('gives up on a loop', () => {
    const loop = machine.transitions.map((t) => (t.target === 'finished' ? { ...t, target: 'a' } : t))
    expect(
      chainOf(
        flow,
        loop.filter((t) => t.target !== 'failed'),
        [],
      ),
    ).toBeUndefined()
  })
})

describe('layOut', () => {
  it('keeps a straight machine in one row where there is room', async () => {
    const { boxes } = await layOut(machine, { direction: 'RIGHT', rowLimit: Infinity }, noCall)
    expect(new Set(machine.children.map((child) => boxes.get(child.path)?.y)).size).toBe(1)
  })

  it('breaks a long chain into rows where there is not', async () => {
    const wide = await layOut(machine, { direction: 'RIGHT', rowLimit: Infinity }, noCall)
    const squarish = await layOut(machine, { direction: 'RIGHT', rowLimit: 700 }, noCall)
    expect(new Set(machine.children.map((child) => squarish.boxes.get(child.path)?.y)).size).toBeGreaterThan(1)
    expect(squarish.size.width).toBeLessThan(wide.size.width)
    expect(squarish.size.width).toBeLessThanOrEqual(760)
  })

  it('lets no two children overlap and keeps them inside', async () => {
    const { boxes, size } = await layOut(machine, { direction: 'RIGHT', rowLimit: 700 }, noCall)
    const all = [...boxes.values()]
    for (const [index, a] of all.entries()) {
      expect(a.x + a.width).toBeLessThanOrEqual(size.width)
      expect(a.y + a.height).toBeLessThanOrEqual(size.height)
      for (const b of all.slice(index + 1)) {
        const apart = a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y
        expect(apart).toBe(true)
      }
    }
  })

  it('draws the regions of a concurrency container without arrows, arrows inside them shifted with them', async () => {
    const left = straight('root/left', ['x', 'y'])
    const right = straight('root/right', ['x', 'y'])
    const both: GraphNode = { ...leaf('root'), kind: 'concurrency', children: [left, right] }
    const { boxes, courses } = await layOut(both, { direction: 'RIGHT', rowLimit: Infinity }, noCall)
    expect(courses.map((course) => course.machine)).toEqual(['root/left', 'root/left', 'root/right', 'root/right'])
    const box = boxes.get('root/right')
    const inside = courses.filter((course) => course.machine === 'root/right').flatMap((course) => course.points)
    for (const point of inside) {
      expect(point.y).toBeGreaterThan(box?.y ?? Infinity)
      expect(point.x).toBeLessThan((box?.x ?? 0) + (box?.width ?? 0))
    }
  })

  it('breaks the chains inside of containers too', async () => {
    const long = straight('root/left', ['a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'])
    const both: GraphNode = { ...leaf('root'), kind: 'concurrency', children: [long] }
    const { size } = await layOut(both, { direction: 'RIGHT', rowLimit: 800 }, noCall)
    expect(size.width).toBeLessThanOrEqual(860)
  })

  it('asks the layout engine about a machine that branches', async () => {
    const branching = { ...machine, transitions: [...machine.transitions, { source: 'a', outcome: 'again', target: 'c' }] }
    const asked: string[] = []
    await layOut(branching, { direction: 'RIGHT', rowLimit: Infinity }, (graph) => {
      asked.push(graph.id)
      return Promise.resolve({ ...graph, edges: [] })
    })
    expect(asked).toEqual(['root'])
  })
})

describe('roundedPath', () => {
  it('rounds corners by no more than half of the shorter leg', () => {
    const points = [
      { x: 0, y: 0 },
      { x: 4, y: 0 },
      { x: 4, y: 100 },
    ]
    expect(roundedPath(points)).toBe('M 0 0 L 2 0 Q 4 0 4 2 L 4 100')
  })
})

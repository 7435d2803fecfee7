/** Graphs that are alike are the same graph to the layout engine. */
import { expect, it } from 'vitest'
import { anonymous } from './anonymous'
import type { ElkShape } from './elkGraph'

function machine(path: string, width = 100): ElkShape {
  return {
    id: path,
    layoutOptions: { 'elk.direction': 'RIGHT' },
    children: ['a', 'b'].map((name) => ({ id: `${path}/${name}`, width, height: 40, ports: [{ id: `${path}/${name}>` }] })),
    edges: [{ id: `${path}|a|done`, sources: [`${path}/a`], targets: [`${path}/b>`] }],
  }
}

it('makes graphs equal that differ in names only', () => {
  expect(anonymous(machine('root/one')).graph).toEqual(anonymous(machine('root/another')).graph)
  expect(anonymous(machine('root/one')).graph).not.toEqual(anonymous(machine('root/one', 120)).graph)
  expect(JSON.stringify(anonymous(machine('root/one')).graph)).not.toContain('root')
})

it('gives each its names back and leaves the shared answer as it is', () => {
  const [one, other] = [anonymous(machine('root/one')), anonymous(machine('root/other'))]
  const answer = { ...one.graph, width: 300 }
  expect(one.named(answer)).toEqual({ ...machine('root/one'), width: 300 })
  expect(other.named(answer)).toEqual({ ...machine('root/other'), width: 300 })
  expect(answer.id).toBe(one.graph.id)
})

it('leaves a name alone that it has not given', () => {
  expect(anonymous(machine('root')).named({ id: 'zz' }).id).toBe('zz')
})

/** Much is put on the canvas little by little. */
import { expect, it } from 'vitest'
import { nodeBatches } from './nodeBatches'

const frames = ['a', 'b', 'c'].map((id) => ({ id }))
const inside = frames.flatMap(({ id }) => [1, 2, 3].map((number) => ({ id: `${id}${number}`, parentId: id })))
const all = [...frames, ...inside]
const ids = (steps: readonly (readonly { id: string }[])[]) => steps.map((step) => step.map(({ id }) => id).join(' '))

it('takes one step where there is little that is new', () => {
  expect(nodeBatches(all, (id) => id !== 'b', 4)).toEqual([all])
})

it('begins with what is there and adds no more than so many each time, in their order', () => {
  expect(ids(nodeBatches(all, (id) => ['a', 'b', 'c'].includes(id), 4))).toEqual([
    'a b c',
    'a b c a1 a2 a3 b1',
    'a b c a1 a2 a3 b1 b2 b3 c1 c2',
    'a b c a1 a2 a3 b1 b2 b3 c1 c2 c3',
  ])
})

it('never has anything before what it stands in, also where that is new and its inside is not', () => {
  const steps = nodeBatches(all, (id) => id.startsWith('b') && id !== 'b', 5)
  for (const step of steps) {
    const there = new Set(step.map(({ id }) => id))
    expect(inside.filter(({ id, parentId }) => there.has(id) && !there.has(parentId))).toEqual([])
  }
  expect(steps.at(-1)).toEqual(all)
})

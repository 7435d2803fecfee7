/** The order in which a machine is read. */
import { expect, it } from 'vitest'
import { flowOf } from './flow'

const to = (source: string, outcome: string, target: string) => ({ source, outcome, target })

it('follows the transitions, not the document: the first outcome of each state first', () => {
  const transitions = [to('look', 'seen', 'grasp'), to('look', 'none', 'wait'), to('grasp', 'done', 'place'), to('wait', 'done', 'place')]
  const order = ['look', 'grasp', 'wait', 'place']
  expect(flowOf(['place', 'wait', 'grasp', 'look'], transitions, 'look')).toMatchObject({ order, loose: [] })
})

it('reads a loop from where it is entered', () => {
  const transitions = [to('a', 'done', 'b'), to('b', 'again', 'a'), to('b', 'done', 'c')]
  expect(flowOf(['c', 'b', 'a'], transitions, 'a').order).toEqual(['a', 'b', 'c'])
})

it('puts aside what nothing leads to or from, and behind the others what the flow does not reach', () => {
  const transitions = [to('a', 'done', 'b'), to('x', 'done', 'y'), to('z', 'again', 'z')]
  expect(flowOf(['new', 'x', 'y', 'a', 'b', 'z'], transitions, 'a')).toMatchObject({ order: ['a', 'b', 'x', 'y', 'z'], loose: ['new'] })
})

it('begins with the first child where the machine does not say', () => {
  expect(flowOf(['a', 'b'], [], null)).toMatchObject({ order: ['a'], loose: ['b'] })
  expect(flowOf([], [], null)).toMatchObject({ order: [], loose: [] })
})

it('follows a chain of thousands', () => {
  const names = Array.from({ length: 2000 }, (_, index) => `s${index}`)
  const transitions = names.slice(1).map((name, index) => to(names[index] ?? '', 'done', name))
  expect(flowOf(names.toReversed(), transitions, 's0').order).toEqual(names)
})

it('puts what follows the first outcome above what follows the others, and each node below the last that leads to it', () => {
  const transitions = [
    to('look', 'seen', 'grasp'),
    to('look', 'none', 'wait'),
    to('grasp', 'done', 'place'),
    to('grasp', 'lost', 'failed'),
    to('wait', 'done', 'ask'),
    to('ask', 'done', 'rest'),
    to('place', 'done', 'rest'),
    to('look', 'tired', 'rest'),
  ]
  const names = ['look', 'grasp', 'wait', 'place', 'ask', 'rest']
  expect(flowOf(names, transitions, 'look').downwards).toEqual(['look', 'grasp', 'place', 'rest', 'failed', 'wait', 'ask'])
})

it('lets a transition that is added to a loop lead back, wherever the loop is entered', () => {
  const transitions = [to('a', 'done', 'b'), to('b', 'done', 'c'), to('c', 'done', 'd'), to('a', 'skip', 'c')]
  const { order } = flowOf(['a', 'b', 'c', 'd'], transitions, 'a')
  expect(flowOf(['a', 'b', 'c', 'd'], [...transitions, to('d', 'again', 'b'), to('d', 'anew', 'a')], 'a').order).toEqual(order)
})

it('begins what nothing leads to at its own start', () => {
  const transitions = [to('a', 'done', 'b'), to('x', 'done', 'y')]
  expect(flowOf(['y', 'x', 'a', 'b'], transitions, 'a').order).toEqual(['a', 'b', 'x', 'y'])
})

it('never reads the start behind what nothing leads to', () => {
  expect(flowOf(['new', 'a', 'b'], [to('a', 'done', 'b'), to('new', 'done', 'a')], 'a').order).toEqual(['a', 'b', 'new'])
})

it('lets the document decide where a loop is entered at several places', () => {
  const transitions = [to('a', 'done', 'c'), to('a', 'other', 'b'), to('b', 'done', 'c'), to('c', 'done', 'd')]
  const more = [...transitions, to('c', 'lost', 'new'), to('new', 'done', 'b')]
  expect(flowOf(['a', 'b', 'c', 'd'], transitions, 'a').order).toEqual(['a', 'b', 'c', 'd'])
  expect(flowOf(['a', 'b', 'c', 'd', 'new'], more, 'a').order).toEqual(['a', 'b', 'c', 'd', 'new'])
})

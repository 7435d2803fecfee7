/** The order in which a machine is read. */
import { expect, it } from 'vitest'
import { flowOf } from './flow'

const to = (source: string, outcome: string, target: string) => ({ source, outcome, target })

it('follows the transitions, not the document: the first outcome of each state first', () => {
  const transitions = [to('look', 'seen', 'grasp'), to('look', 'none', 'wait'), to('grasp', 'done', 'place'), to('wait', 'done', 'place')]
  expect(flowOf(['place', 'wait', 'grasp', 'look'], transitions, 'look')).toEqual({ order: ['look', 'grasp', 'wait', 'place'], loose: [] })
})

it('reads a loop from where it is entered', () => {
  const transitions = [to('a', 'done', 'b'), to('b', 'again', 'a'), to('b', 'done', 'c')]
  expect(flowOf(['c', 'b', 'a'], transitions, 'a').order).toEqual(['a', 'b', 'c'])
})

it('puts aside what nothing leads to or from, and behind the others what the flow does not reach', () => {
  const transitions = [to('a', 'done', 'b'), to('x', 'done', 'y'), to('z', 'again', 'z')]
  expect(flowOf(['new', 'x', 'y', 'a', 'b', 'z'], transitions, 'a')).toEqual({ order: ['a', 'b', 'x', 'y', 'z'], loose: ['new'] })
})

it('begins with the first child where the machine does not say', () => {
  expect(flowOf(['a', 'b'], [], null)).toEqual({ order: ['a'], loose: ['b'] })
  expect(flowOf([], [], null)).toEqual({ order: [], loose: [] })
})

it('follows a chain of thousands', () => {
  const names = Array.from({ length: 2000 }, (_, index) => `s${index}`)
  const transitions = names.slice(1).map((name, index) => to(names[index] ?? '', 'done', name))
  expect(flowOf(names.toReversed(), transitions, 's0').order).toEqual(names)
})

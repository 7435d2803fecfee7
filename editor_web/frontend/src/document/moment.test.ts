/** A time of a run and a node in the address. */
import { expect, it } from 'vitest'
import { momentOf, momentText } from './moment'

it.each([
  [12.4, 'root/grasp'],
  [0, undefined],
  [undefined, 'root/a b&c=d+e%'],
  [undefined, undefined],
])('names %s and %j, and finds them again', (timeS, node) => {
  expect(momentOf(`#${momentText(timeS, node)}`)).toEqual({ timeS, node })
})

it('is legible', () => {
  expect(momentText(12.4, 'root/grasp')).toBe('t=12.4&node=root/grasp')
})

it.each(['', '#', '#12', '#t=', '#t=soon', '#t=-1', '#root/grasp'])('names nothing with %j', (hash) => {
  expect(momentOf(hash)).toEqual({ timeS: undefined, node: undefined })
})

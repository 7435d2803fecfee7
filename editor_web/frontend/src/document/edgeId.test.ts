import { expect, it } from 'vitest'
import { edgeId, edgeOf, isEdgeId, outcomeId, outcomeOf, sourceOf, transitionId } from './edgeId'

const START = { machine: 'root/inner', source: 'grasp', outcome: 'held' }

it('reads what it has made', () => {
  expect(edgeOf(edgeId(START))).toEqual(START)
  expect(outcomeOf(outcomeId('root/inner', 'held'))).toEqual({ machine: 'root/inner', outcome: 'held' })
  expect(sourceOf(START)).toBe('root/inner/grasp')
  expect(transitionId(START)).toBe('grasp|held')
})

it.each(['', 'root/inner', 'root|grasp', 'root|grasp|held|more', '|grasp|held'])('takes %j for no arrow', (id) => {
  expect(isEdgeId(id)).toBe(false)
  expect(edgeOf(id)).toBeUndefined()
  expect(outcomeOf(id)).toBeUndefined()
})

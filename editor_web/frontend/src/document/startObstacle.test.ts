/** Why a run cannot be started. */
import { expect, it } from 'vitest'
import { startObstacle } from './startObstacle'

const SHIFT = { id: 'behaviors/shift.yaml', findings: [], fit: { cell: '', obstacle: '' } }
const OPERATOR = { role: 'operator' }

it('is the stop of the cell until it is released', () => {
  expect(startObstacle(SHIFT, [], OPERATOR, { phase: 'stopped' })).toContain('The cell is stopped')
  expect(startObstacle(SHIFT, [], OPERATOR, { phase: 'stopping' })).toContain('The cell is stopped')
  expect(startObstacle(SHIFT, [], OPERATOR, { phase: 'released' })).toBeUndefined()
})

it('is a run of the same behavior, and no other one', () => {
  expect(startObstacle(SHIFT, [{ behavior: SHIFT.id }], OPERATOR, null)).toBe('A run of this behavior is active')
  expect(startObstacle(SHIFT, [{ behavior: 'behaviors/nap.yaml' }], OPERATOR, null)).toBeUndefined()
})

it('is the cell that a behavior is written for, and who may look only', () => {
  const turn = { ...SHIFT, fit: { cell: 'lathe', obstacle: 'it is written for the cell lathe' } }
  expect(startObstacle(turn, [], OPERATOR, { phase: 'stopped' })).toBe('It cannot be started here: it is written for the cell lathe')
  expect(startObstacle(SHIFT, [], { role: 'viewer' }, null)).toContain('log in with the operator token')
})

import { expect, it } from 'vitest'
import type { Shrinking, Shrunk, TrialResult } from '../api/types'
import { chanceText, designText, failuresText, foundOf, proposedCase, rangeText, shrunkRows } from './searches'

const RUN = { number: 4, seed: 11, values: { 'cell.mass_kg': 2.5, faults: 'slip.yaml' } }
const SHRUNK: Shrunk = {
  result: { configuration: { ...RUN, seed: 0 } } as unknown as TrialResult,
  changed: { 'cell.mass_kg': [0.5, 1.90625], faults: ['none', 'slip.yaml'] },
  runs: 30,
  passes: { 'cell.mass_kg': 1.8751 },
  seed_matters: false,
  placement_noise: false,
  interrupted: false,
}
const FOUND: Shrinking = {
  status: 'idle',
  progress: null,
  found: { subject: 'f00', failing: RUN, shrunk: SHRUNK },
  saved_as: '',
  problem: '',
}

it('lists what is left of a change, with the nearest value that does not fail', () => {
  expect(shrunkRows(SHRUNK)).toEqual([
    { address: 'cell.mass_kg', nominal: '0.5', failing: '1.906', passing: '1.875' },
    { address: 'faults', nominal: 'none', failing: 'slip.yaml', passing: '' },
  ])
})

it.each([
  [{}, 'Seed 0, without placement noise.'],
  [{ seed_matters: true, placement_noise: true }, 'Seed 0: with the nominal one it does not fail so; with placement noise.'],
  [{ changed: {}, seed_matters: true }, 'Nothing is varied: seed 0 alone fails, without placement noise.'],
  [{ changed: {} }, 'Nothing is varied: it fails with all nominal values, without placement noise.'],
])('says what chance has to do with it: %j', (told, words) => {
  expect(chanceText({ ...SHRUNK, ...told })).toBe(words)
})

it('takes what was found only for the run and the versions that it is of', () => {
  expect(foundOf(FOUND, 'f00', RUN)?.shrunk).toBe(SHRUNK)
  expect(foundOf(FOUND, 'f01', RUN)).toBeUndefined()
  expect(foundOf(FOUND, 'f00', { ...RUN, seed: 12 })).toBeUndefined()
  expect(foundOf(undefined, 'f00', RUN)).toBeUndefined()
})

it('names searches, failures, ranges and files', () => {
  const line = {
    id: 's',
    description: '',
    behavior: '',
    design: 'latin_hypercube',
    require: '',
    towards: '',
    factors: [],
    live: {} as never,
    problem: '',
  }
  expect(designText(line)).toBe('latin hypercube design')
  expect(designText({ ...line, towards: 'failure' })).toBe('search for failures')
  expect(designText({ ...line, towards: 'least left.force_n' })).toBe('search for failures towards least left.force_n')
  expect([0, 1, 2].map((failures) => failuresText({ failures, nearest: null, is_satisfied: false }))).toEqual([
    'no failure',
    '1 failure',
    '2 failures',
  ])
  expect([rangeText([0.12345, 2], false), rangeText(['none', 'slip.yaml'], true)]).toEqual(['0.1235 to 2', 'none, slip.yaml'])
  expect(proposedCase('behaviors/sweeps/transfer.yaml', 17)).toBe('tests/cases/transfer_17.yaml')
})

import { expect, it } from 'vitest'
import { initialsOf, placeWords } from './presence'

const ADA = { page: 1, name: 'Ada', role: 'operator', document: '', node: '', edits: false, operates: '', since_s: null }

it('shortens names to initials', () => {
  expect(['Ada Lovelace', 'ada', 'Operator 12', ''].map(initialsOf)).toEqual(['AL', 'A', 'O1', ''])
})

it('says what a page shows', () => {
  expect(placeWords(ADA)).toBe('May operate')
  expect(placeWords({ ...ADA, role: 'viewer' })).toBe('Looks only')
  expect(placeWords({ ...ADA, document: 'behaviors/a.yaml', node: 'root/go', edits: true })).toBe('Edits a.yaml, go selected')
  expect(placeWords({ ...ADA, document: 'behaviors/a.yaml' })).toBe('Shows a.yaml')
})

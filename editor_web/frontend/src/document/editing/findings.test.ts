import { expect, test } from 'vitest'
import type { FindingView } from '../../api/types'
import { problemsOf, sameFindings } from './findings'

const at = (line: number, code: string): FindingView => ({
  severity: 'warning',
  code,
  message: '',
  path: 'root',
  line,
  column: 1,
  hint: '',
})

test('targets stand among the findings in the order of the text', () => {
  const draft = { findings: [at(3, 'a'), at(9, 'b')], targets: [at(5, 'target-in-collision')] }
  expect(problemsOf(draft).map((each) => each.code)).toEqual(['a', 'target-in-collision', 'b'])
})

test('the list is the same one as long as its parts are, and that of the check without targets', () => {
  const draft = { findings: [at(3, 'a')], targets: [at(5, 'b')] }
  expect(problemsOf(draft)).toBe(problemsOf({ ...draft }))
  expect(problemsOf({ ...draft, targets: [] })).toBe(draft.findings)
})

test('findings that say the same stay the same list', () => {
  const before = [at(3, 'a')]
  expect(sameFindings(before, [at(3, 'a')])).toBe(before)
  expect(sameFindings(before, [at(4, 'a')])).not.toBe(before)
})

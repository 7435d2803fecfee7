import { expect, test } from 'vitest'
import type { FindingView } from '../../api/types'
import { emptyContainers, problemsOf, sameFindings, unfinishedWords } from './findings'
import type { EditNode } from './model'

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
  const draft = { findings: [at(3, 'a'), at(9, 'b')], targets: [at(5, 'target-in-collision')], root: undefined }
  expect(problemsOf(draft).map((each) => each.code)).toEqual(['a', 'target-in-collision', 'b'])
})

test('the list is the same one as long as its parts are, and that of the check without targets', () => {
  const draft = { findings: [at(3, 'a')], targets: [at(5, 'b')], root: undefined }
  expect(problemsOf(draft)).toBe(problemsOf({ ...draft }))
  expect(problemsOf({ ...draft, targets: [] })).toBe(draft.findings)
})

test('findings that say the same stay the same list', () => {
  const before = [at(3, 'a')]
  expect(sameFindings(before, [at(3, 'a')])).toBe(before)
  expect(sameFindings(before, [at(4, 'a')])).not.toBe(before)
})

test('a container that is being built has no problems until something is in it', () => {
  const child = { path: 'root/a', kind: 'state', children: [] } as unknown as EditNode
  const empty = { path: 'root', kind: 'machine', children: [] } as unknown as EditNode
  const findings = [at(6, 'invalid-document'), at(7, 'unknown-state')]
  const codes = (root: EditNode) => problemsOf({ findings, targets: [], root }).map((each) => each.code)
  expect([...emptyContainers(empty)]).toEqual(['root'])
  expect(codes(empty)).toEqual(['unknown-state'])
  expect(codes({ ...empty, children: [child] })).toEqual(['invalid-document', 'unknown-state'])
})

test('what is left to do says how many containers are empty', () => {
  const root = (kind: string, children: EditNode[] = [], path = 'root') => ({ path, kind, children }) as unknown as EditNode
  expect(unfinishedWords(undefined)).toBe('')
  expect(unfinishedWords(root('state'))).toBe('')
  expect(unfinishedWords(root('machine'))).toBe('A container is empty: add a node to it.')
  expect(unfinishedWords(root('machine', [root('machine', [], 'root/a'), root('sequence', [], 'root/b')]))).toBe(
    '2 containers are empty: add a node to each.',
  )
})

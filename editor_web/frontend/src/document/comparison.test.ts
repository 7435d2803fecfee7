/** What differs of a visit, and how the address names it. */
import { expect, it } from 'vitest'
import type { AlignedVisit, Visit } from '../api/types'
import { alignedMoment, differenceS, durationOf, endWords, indexAt, isDifferent, placeOf, signed } from './comparison'

function visit(told: Partial<Visit> = {}): Visit {
  return { path: 'root/a', start_s: 1, end_s: 3, status: 'done', outcome: 'ok', visit: 1, seq: 2, end_seq: 5, count: 1, cause: '', ...told }
}

function pair(left: Visit | null, right: Visit | null): AlignedVisit {
  return { path: (left ?? right)?.path ?? '', left, right }
}

it('differs where a visit is missing or ended otherwise, and not by its duration', () => {
  expect(isDifferent(pair(visit(), null))).toBe(true)
  expect(isDifferent(pair(visit(), visit({ outcome: 'bad' })))).toBe(true)
  expect(isDifferent(pair(visit(), visit({ status: 'failed' })))).toBe(true)
  expect(isDifferent(pair(visit(), visit({ end_s: 9 })))).toBe(false)
})

it('subtracts the left duration from the right one', () => {
  expect(differenceS(durationOf(visit()), durationOf(visit({ end_s: 2 })))).toBe(-1)
  expect(differenceS(durationOf(null), 2)).toBeUndefined()
  expect(durationOf(visit({ end_s: null }))).toBeUndefined()
  expect([signed(0.254), signed(-0.254), signed(0.004), signed(undefined)]).toEqual(['+0.25 s', '−0.25 s', '', ''])
})

it('tells how a visit ended', () => {
  expect([
    endWords(null),
    endWords(visit()),
    endWords(visit({ outcome: '', status: 'stopped' })),
    endWords(visit({ status: 'active', end_s: null })),
  ]).toEqual(['not entered', 'ok', 'stopped', 'not ended'])
})

it('names each visit of a comparison in the address, and finds it again', () => {
  const visits = [pair(visit(), visit()), pair(visit({ visit: 2 }), null), pair(null, visit({ visit: 2 })), pair(null, visit({ visit: 3 }))]
  expect(visits.map(placeOf)).toEqual(['root/a@1', 'root/a@2', 'root/a@r2', 'root/a@r3'])
  expect(visits.map((each) => indexAt(visits, placeOf(each)))).toEqual([0, 1, 2, 3])
  expect([indexAt(visits, ''), indexAt(visits, 'root/b@1')]).toEqual([undefined, undefined])
})

it('shows both runs at the same time since the start of a visit', () => {
  const aligned = { path: 'root/a', left: { start_s: 3 }, right: { start_s: 5 } } as AlignedVisit
  expect(alignedMoment('l', 'r', aligned, 0.5)).toEqual({ solid: ['l', 3.5], ghost: ['r', 5.5] })
  expect(alignedMoment('l', 'r', undefined, 0.5)).toEqual({ solid: ['l', 0.5], ghost: ['r', 0.5] })
  expect(alignedMoment('l', 'r', { ...aligned, right: null }, 0)).toEqual({ solid: ['l', 3], ghost: undefined })
  expect(alignedMoment('l', 'r', { ...aligned, left: null }, 0)).toEqual({ solid: ['r', 5], ghost: undefined })
})

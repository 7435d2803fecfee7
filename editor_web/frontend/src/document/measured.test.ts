/** Measured facts stand among the events of a timeline, in the lanes of their nodes. */
import { expect, it } from 'vitest'
import type { MeasuredMarker, TimelineMarker } from '../api/types'
import { laneWords, rowOf, valueWords, withMeasured } from './measured'
import { neighbor, rowsOf } from './timeline'

const measured = (time_s: number, seq: number, rest: Partial<MeasuredMarker> = {}): MeasuredMarker => ({
  kind: 'force',
  seq,
  time_s,
  path: 'root/a',
  device: 'left',
  value: 12.345,
  unit: 'N',
  limit: 10,
  text: 'left: external force above what was asked for',
  ...rest,
})
const event = (seq: number): TimelineMarker => ({ seq, time_s: seq / 10, kind: 'goal', path: 'root', text: 'goal' })

it('puts them between the events, by time', () => {
  const marks = withMeasured([event(1), event(5)], [measured(0.3, 2), measured(0.1, 1, { kind: 'limit' })])
  expect(marks.map((mark) => [mark.time_s, mark.kind])).toEqual([
    [0.1, 'goal'],
    [0.1, 'limit'],
    [0.3, 'force'],
    [0.5, 'goal'],
  ])
  expect(marks[2]?.text).toBe('left: external force above what was asked for: 12.3 N, limit 10 N')
})

it('is gone to from mark to mark, also where several are between two events', () => {
  const marks = withMeasured([event(1), event(5)], [measured(0.2, 1), measured(0.3, 1)])
  expect(neighbor(marks, { timeS: 0.1, seq: 1 }, 1)?.time_s).toBe(0.2)
  expect(neighbor(marks, { timeS: 0.2, seq: 1 }, 1)?.time_s).toBe(0.3)
  expect(neighbor(marks, { timeS: 0.3, seq: 1 }, -1)?.time_s).toBe(0.2)
  expect(neighbor(marks, { timeS: 0.5, seq: 5 }, 1)).toBeUndefined()
})

it.each([
  [{}, '12.3 N, limit 10 N', 'Force 12.3 N'],
  [{ kind: 'grasp' }, '12.3 N, asked for 10 N', 'Force 12.3 N'],
  [{ limit: null }, '12.3 N', 'Force 12.3 N'],
  [{ value: null }, '', 'Force'],
  [{ value: 6.5e-9 }, '0 N, limit 10 N', 'Force 0 N'],
] as const)('says only what is known: %j', (rest, words, lane) => {
  expect(valueWords(measured(0, 1, rest))).toBe(words)
  expect(laneWords('Force', measured(0, 1, rest))).toBe(lane)
})

it('stands in the lane of its node, or of what that is folded in', () => {
  const paths = ['root', 'root/a', 'root/a/b']
  expect(rowOf(rowsOf(paths, paths, new Set()), 'root/a/b')).toBe(2)
  expect(rowOf(rowsOf(paths, paths, new Set(['root/a'])), 'root/a/b')).toBe(1)
  expect(rowOf(rowsOf(paths, paths, new Set()), '')).toBe(-1)
})

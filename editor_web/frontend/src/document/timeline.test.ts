/** Rows, views, ticks and marks of a timeline. */
import { describe, expect, it } from 'vitest'
import type { PastRunState, NodeLive, ActivationInterval, TimelineMarker, Timeline } from '../api/types'
import { EMPTY } from './live'
import {
  afterKey,
  neighbor,
  panned,
  placeWords,
  revealing,
  rowsOf,
  spanAt,
  ticks,
  timeAt,
  wholeView,
  withTimeline,
  xOf,
  zoomed,
} from './timeline'
import { atMoment, nextMoment } from './timelineMoment'

const span = (seq: number, start_s: number, end_s: number | null): ActivationInterval => ({
  seq,
  start_s,
  end_s,
  end_seq: end_s === null ? 0 : seq + 1,
  status: end_s === null ? 'active' : 'done',
  outcome: '',
  visit: 1,
  count: 1,
})
const mark = (seq: number, kind = 'goal'): TimelineMarker => ({ seq, time_s: seq / 10, kind, path: 'root', text: '' })
const told = (seq: number, rows: Timeline['rows'], marks: readonly TimelineMarker[] = [], merged = false): Timeline => ({
  run: 'r',
  seq,
  duration_s: seq / 10,
  ended: false,
  merged,
  rows,
  marks,
  left_out: 0,
})

describe('what the server tells', () => {
  it('is added to what is known, and a span that was open is closed', () => {
    const first = withTimeline(undefined, told(5, [{ path: 'root', spans: [span(1, 0, null)] }], [mark(2)]))
    const second = withTimeline(first, told(9, [{ path: 'root', spans: [span(1, 0, 0.8), span(8, 0.8, null)] }], [mark(7)]))
    expect(second.rows.get('root')).toEqual([span(1, 0, 0.8), span(8, 0.8, null)])
    expect(second.marks.map((each) => each.seq)).toEqual([2, 7])
    expect([second.seq, second.durationS]).toEqual([9, 0.9])
  })

  it('takes the place of what is known where spans are merged', () => {
    const first = withTimeline(undefined, told(5, [{ path: 'root/a', spans: [span(1, 0, 1)] }]))
    const second = withTimeline(first, told(9, [{ path: 'root/b', spans: [span(3, 0, 1)] }], [], true))
    expect([...second.rows.keys()]).toEqual(['root/b'])
  })
})

describe('rows', () => {
  it('are in the order of the graph, parents included, what the graph does not have at the end', () => {
    const rows = rowsOf(['root/b/x', 'root/a', 'root/gone'], ['root', 'root/b', 'root/b/x', 'root/a', 'root/never'], new Set())
    expect(rows.map((row) => row.path)).toEqual(['root', 'root/b', 'root/b/x', 'root/a', 'root/gone'])
    expect(rows.map((row) => row.depth)).toEqual([0, 1, 2, 1, 1])
    expect(rows.map((row) => row.hasChildren)).toEqual([true, true, false, false, false])
  })

  it('hide what is inside of a closed one', () => {
    const rows = rowsOf(['root/b/x', 'root/bb'], ['root', 'root/b', 'root/b/x', 'root/bb'], new Set(['root/b']))
    expect(rows.map((row) => `${row.path} ${row.isOpen}`)).toEqual(['root true', 'root/b false', 'root/bb true'])
  })
})

describe('the view', () => {
  it('stays around the time that is zoomed at, and inside the run', () => {
    const near = zoomed({ fromS: 0, untilS: 100 }, 0.5, 30, 100)
    expect(near).toEqual({ fromS: 15, untilS: 65 })
    expect(zoomed(near, 10, 30, 100)).toEqual({ fromS: 0, untilS: 100 })
    expect(panned(near, 1000, 100)).toEqual({ fromS: 50, untilS: 100 })
    expect(panned(near, -1000, 100)).toEqual({ fromS: 0, untilS: 50 })
  })

  it('is never of no length', () => {
    expect(wholeView(0).untilS).toBeGreaterThan(0)
    const tiny = zoomed({ fromS: 0, untilS: 10 }, 1e-9, 5, 10)
    expect(tiny.untilS - tiny.fromS).toBeCloseTo(0.005)
  })

  it('moves to a time that is outside, and only then', () => {
    const view = { fromS: 10, untilS: 20 }
    expect(revealing(view, 15, 100)).toBe(view)
    expect(revealing(view, 25, 100)).toEqual({ fromS: 15, untilS: 25 })
    expect(revealing(view, 2, 100)).toEqual({ fromS: 2, untilS: 12 })
  })

  it('turns times into places and back', () => {
    const view = { fromS: 10, untilS: 20 }
    expect(xOf(view, 500, 15)).toBe(250)
    expect(timeAt(view, 500, 250)).toBe(15)
  })

  it.each([
    [{ fromS: 0, untilS: 10 }, 900, ['0 s', '1 s', '2 s']],
    [{ fromS: 0, untilS: 0.1 }, 900, ['0.00 s', '0.01 s', '0.02 s']],
    [{ fromS: 58, untilS: 68 }, 900, ['58 s', '59 s', '1:00']],
  ] as const)('has round ticks: %j', (view, width, labels) => {
    expect(
      ticks(view, width)
        .slice(0, 3)
        .map((tick) => tick.label),
    ).toEqual(labels)
  })
})

it('finds the span at a time, or one that is near', () => {
  const spans = [span(1, 0, 1), span(3, 2, 2), span(5, 4, null)]
  expect(spanAt(spans, 0.5, 0)?.seq).toBe(1)
  expect(spanAt(spans, 1.5, 0)).toBeUndefined()
  expect(spanAt(spans, 1.9, 0.2)?.seq).toBe(3)
  expect(spanAt(spans, 99, 0)?.seq).toBe(5)
})

it('goes from mark to mark, also among those of one time', () => {
  const marks = [mark(2), mark(5), mark(6)]
  expect(neighbor(marks, { timeS: 0.5, seq: 5 }, 1)?.seq).toBe(6)
  expect(neighbor(marks, { timeS: 0.5, seq: 5 }, -1)?.seq).toBe(2)
  expect(neighbor(marks, { timeS: 0.6, seq: 6 }, 1)).toBeUndefined()
})

it.each([
  ['ArrowRight', false, 5.1],
  ['ArrowLeft', true, 4],
  ['Home', false, 0],
  ['End', false, 20],
  ['x', false, undefined],
] as const)('goes by keys: %s', (key, isFar, expected) => {
  expect(afterKey(key, isFar, 5, { fromS: 0, untilS: 10 }, 20)).toBe(expected)
})

it('says where it is', () => {
  expect(placeWords(12.4, 38.2)).toBe('12.40 s of 38.20 s')
})

describe('a moment', () => {
  const node = (status: string): NodeLive => ({
    status,
    visits: 1,
    outcome: '',
    entered_s: 0,
    duration_s: 0,
    cause: '',
    last_transition: '',
    taken: {},
    plan: null,
  })
  const moment = (seq: number, nodes: PastRunState['nodes'], lines: readonly number[]): PastRunState => ({
    seq,
    time_s: seq / 10,
    nodes,
    log: lines.map((line) => ({ seq: line, time_s: 0, kind: 'log', level: 'info', path: '', text: '', causes: [] })),
    dropped: 0,
  })

  it('is shown in the place of the live picture, whose list of runs stays', () => {
    const shown = nextMoment(undefined, moment(4, { root: node('active') }, [4]), 0.45)
    const state = atMoment({ ...EMPTY, nowS: 9, ticking: true, nodes: { root: node('done') } }, shown)
    expect([state.nowS, state.ticking, state.nodes['root']?.status]).toEqual([0.45, false, 'active'])
  })

  it('keeps what says the same', () => {
    const first = nextMoment(undefined, moment(4, { root: node('active'), 'root/a': node('idle') }, [3, 4]), 0.4)
    const second = nextMoment(first, moment(5, { root: node('active'), 'root/a': node('active') }, [4, 5]), 0.5)
    expect(second.nodes['root']).toBe(first.nodes['root'])
    expect(second.nodes['root/a']).not.toBe(first.nodes['root/a'])
    expect(second.log[0]).toBe(first.log[1])
  })
})

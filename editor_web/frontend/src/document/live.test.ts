/** The live picture: snapshots replace, deltas add, gaps ask anew. */
import { describe, expect, it } from 'vitest'
import type { LiveDelta, LogLine, NodeLive, RunView, LiveSnapshot } from '../api/types'
import { EMPTY, fold, LOG_LINES, type LiveState } from './live'

const node = (status: string, visits = 1): NodeLive => ({
  status,
  visits,
  outcome: '',
  entered_s: 0,
  duration_s: 0,
  cause: '',
  last_transition: '',
  taken: {},
  plan: null,
})
const line = (seq: number): LogLine => ({ seq, time_s: 0, kind: 'log', level: 'info', path: '', text: '', causes: [] })
const run = (id: string, started_at_s: number, status = 'running'): RunView => ({
  id,
  behavior: 'b',
  status,
  outcome: null,
  success: false,
  cause: '',
  started_at_s,
  duration_s: 0,
  waits: '',
  ticking: false,
})
const snapshot = (change: Partial<LiveSnapshot> = {}): LiveSnapshot => ({
  k: 'snapshot',
  run: 'r1',
  seq: 3,
  now_s: 1.5,
  ticking: true,
  runs: [run('r1', 1)],
  nodes: { root: node('active') },
  log: [line(1), line(2), line(3)],
  control: null,
  lock_reasons: {},
  robots: {},
  stop: null,
  ...change,
})
const delta = (change: Partial<LiveDelta> = {}): LiveDelta => ({
  k: 'delta',
  run: 'r1',
  after: 3,
  seq: 4,
  now_s: 2,
  ticking: true,
  runs: [],
  nodes: {},
  log: [],
  dropped: 0,
  control: null,
  lock_reasons: {},
  robots: {},
  ...change,
})
const started = fold(EMPTY, snapshot(), 10) as LiveState

describe('fold', () => {
  it('shows a snapshot as it is, also in the middle of a run', () => {
    expect(started).toMatchObject({ run: 'r1', seq: 3, nowS: 1.5, atMs: 10, ticking: true })
    expect(started.nodes['root']?.status).toBe('active')
  })

  it('keeps the nodes that a delta does not name, and lights both that it does', () => {
    const next = fold(started, delta({ nodes: { 'root/a': node('active'), 'root/b': node('active') } }), 20) as LiveState
    expect(Object.keys(next.nodes)).toEqual(['root', 'root/a', 'root/b'])
    expect(next.seq).toBe(4)
  })

  it('asks for a snapshot when something between was missed', () => {
    expect(fold(started, delta({ after: 5, seq: 6 }), 20)).toBe('gap')
  })

  it('asks for a snapshot when a delta is about another run', () => {
    expect(fold(started, delta({ run: 'r2' }), 20)).toBe('gap')
  })

  it('forgets everything when the server was restarted', () => {
    const hello = { k: 'hello', version: 1, epoch: 'new', role: 'operator', server_time_s: 100 } as const
    expect(fold({ ...started, epoch: 'old' }, hello, 30_000)).toEqual({ ...EMPTY, epoch: 'new', role: 'operator', serverZeroS: 70 })
  })

  it('keeps what it shows when the same server answers again', () => {
    const hello = { k: 'hello', version: 1, epoch: 'same', role: 'operator', server_time_s: 0 } as const
    expect((fold({ ...started, epoch: 'same' }, hello, 30) as LiveState).nodes).toBe(started.nodes)
  })

  it('bounds the log and counts what fell out', () => {
    const many = Array.from({ length: LOG_LINES }, (_, index) => line(index + 4))
    const next = fold(started, delta({ log: many, dropped: 7 }), 20) as LiveState
    expect(next.log).toHaveLength(LOG_LINES)
    expect(next.dropped).toBe(3 + 7)
    expect(next.log[0]?.seq).toBe(4)
  })

  it('replaces a changed run in its place and puts a new one first', () => {
    const next = fold(started, delta({ runs: [run('r1', 1, 'finished'), run('r2', 2)] }), 20) as LiveState
    expect(next.runs.map((r) => [r.id, r.status])).toEqual([
      ['r2', 'running'],
      ['r1', 'finished'],
    ])
  })
})

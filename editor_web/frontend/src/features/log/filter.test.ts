/** The log's filter. */
import { expect, it } from 'vitest'
import type { LogLine } from '../../api/types'
import { passing } from './filter'

const line = (seq: number, level: string, path: string, text: string): LogLine => ({
  seq,
  time_s: 0,
  kind: 'log',
  level,
  path,
  text,
  causes: [],
})
const lines = [line(1, 'debug', 'root', 'entered'), line(2, 'info', 'root/pick', 'Held'), line(3, 'error', 'root/pickle', 'lost')]

it.each([
  [{ level: 'debug', text: '', path: '' }, [1, 2, 3]],
  [{ level: 'info', text: '', path: '' }, [2, 3]],
  [{ level: 'debug', text: 'held', path: '' }, [2]],
  [{ level: 'debug', text: '', path: 'root/pick' }, [2]],
] as const)('passes by level, text and node: %j', (filter, passed) => {
  expect(passing(lines, filter).map((l) => l.seq)).toEqual(passed)
})

/** Curves of two recordings over one another, and the numbers that both have. */
import { expect, it } from 'vitest'
import type { TopicFields } from '../../api/types'
import { common, curveId, joined, settledPart } from './recorded'

const LEFT = { address: '/runs/r1', label: 'left', startS: 3 }
const RIGHT = { address: '/runs/r2', label: 'right', startS: 5 }

function topic(name: string, ...paths: string[]): TopicFields {
  return { topic: name, type: 'State', fields: paths.map((path) => ({ path, label: path, unit: '' })) }
}

it('places both at the time since the start of each', () => {
  const curves = joined(
    [LEFT, RIGHT],
    [
      { times_s: [3, 4], fields: ['arm:x'], columns: [[1, 2]] },
      { times_s: [5, 6], fields: ['arm:x'], columns: [[null, 7]] },
    ],
  )
  expect(curves.names).toEqual(['left arm:x', 'right arm:x'])
  expect([curves.time(0), curves.time(1)]).toEqual([0, 1])
  expect([0, 1].map((row) => curves.value('left arm:x', row))).toEqual([1, 2])
  expect([0, 1].map((row) => curves.value('right arm:x', row))).toEqual([NaN, 7])
})

it('has nothing of no recording', () => {
  expect(joined([], []).length).toBe(0)
  expect(curveId({ ...LEFT, label: '' }, 'arm:x')).toBe('arm:x')
})

it('offers the numbers that all recordings have', () => {
  const [first, second] = [
    [topic('arm', 'x', 'y'), topic('tool', 'w')],
    [topic('arm', 'y', 'z'), topic('other', 'w')],
  ]
  expect(common([first, second])).toEqual([topic('arm', 'y')])
  expect(common([first])).toEqual(first)
  expect(common([])).toEqual([])
})

it('asks for more of a run that goes on in steps, and for the seen part as it is', () => {
  expect(settledPart({ fromS: 0, untilS: 7.3 }, 7.3)).toEqual({ fromS: 0, untilS: 6 })
  expect(settledPart({ fromS: 0, untilS: 601 }, 601).untilS).toBe(592)
  expect(settledPart({ fromS: 1, untilS: 3 }, 7.3)).toEqual({ fromS: 1, untilS: 3 })
})

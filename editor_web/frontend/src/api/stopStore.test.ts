/** What waits while a STOP does. */
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { newStop, type StopProgress } from '../document/stopReport'
import { afterStop, useStop } from './stopStore'

const ASKED = newStop(1, true, '')
const ANSWERED: StopProgress = { ...ASKED, engine: { status: 'answered', problem: '' } }
const FAILED = { status: 'failed', problem: 'gone' } as const

beforeEach(() => vi.useFakeTimers())
afterEach(() => {
  useStop.setState({ stop: undefined })
  vi.useRealTimers()
})

function shown(): { readonly frames: number[]; readonly take: (frame: number) => void } {
  const frames: number[] = []
  return { frames, take: afterStop((frame: number) => void frames.push(frame)).take }
}

it('shows at once what comes while there is no stop, and after one is acknowledged', () => {
  const { frames, take } = shown()
  take(1)
  useStop.setState({ stop: ANSWERED })
  take(2)
  expect(frames).toEqual([1, 2])
})

it('lets what comes meanwhile wait until after the words of the stop, in order', () => {
  const { frames, take } = shown()
  useStop.setState({ stop: ASKED })
  take(1)
  take(2)
  expect(frames).toEqual([])
  useStop.setState({ stop: ANSWERED })
  take(3)
  expect(frames).toEqual([])
  vi.runAllTimers()
  take(4)
  expect(frames).toEqual([1, 2, 3, 4])
})

it('waits for the second stop, too, that is asked for before the words of the first are shown', () => {
  const { frames, take } = shown()
  useStop.setState({ stop: ASKED })
  take(1)
  useStop.setState({ stop: ANSWERED })
  useStop.setState({ stop: { ...ASKED, number: 2 } })
  vi.runAllTimers()
  expect(frames).toEqual([])
  useStop.setState({ stop: ANSWERED })
  vi.runAllTimers()
  expect(frames).toEqual([1])
})

it.each<[string, StopProgress | undefined]>([
  ['is told as not acknowledged', { ...ASKED, isUnanswered: true }],
  ['has failed on both ways', { ...ASKED, process: FAILED, engine: FAILED }],
  ['is put away', undefined],
])('shows everything once the stop %s', (_, stop) => {
  const { frames, take } = shown()
  useStop.setState({ stop: ASKED })
  take(1)
  useStop.setState({ stop })
  vi.runAllTimers()
  expect(frames).toEqual([1])
})

/** The timeline ends where the clock of the run is, whenever the page was opened. */
import { act, screen } from '@testing-library/react'
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { live, run, show, snapshot } from '../../../testing/page'
import type { LoadedTimeline } from '../../document/timeline'
import { useRunTime } from './useRunTime'

// Its last event was long before the page was opened.
const COURSE: LoadedTimeline = {
  run: 'r1',
  seq: 4,
  durationS: 0.5,
  ended: false,
  merged: false,
  leftOut: 0,
  rows: new Map(),
  marks: [],
}

function Length({ isWatched = true }: { readonly isWatched?: boolean }) {
  return <output>{useRunTime(COURSE, isWatched).toFixed(1)}</output>
}

beforeEach(() => vi.useFakeTimers({ toFake: ['performance', 'setInterval', 'clearInterval'] }))
afterEach(() => vi.useRealTimers())

it('goes on with the clock of the run, and stands while that is paused', async () => {
  const socket = live({ runs: [run({ duration_s: 12, ticking: true })] })
  show(<Length />)
  await act(() => vi.advanceTimersByTimeAsync(2000))
  expect(screen.getByRole('status')).toHaveTextContent('14.0')
  act(() => socket.tell(snapshot({ runs: [run({ duration_s: 15, ticking: false })] })))
  await act(() => vi.advanceTimersByTimeAsync(5000))
  expect(screen.getByRole('status')).toHaveTextContent('15.0')
})

it('is the length of what was recorded where no clock is known', async () => {
  live({ runs: [run({ id: 'another', duration_s: 12, ticking: true })] })
  show(<Length />)
  await act(() => vi.advanceTimersByTimeAsync(1000))
  expect(screen.getByRole('status')).toHaveTextContent('0.5')
})

it('stands where the run is not followed', async () => {
  live({ runs: [run({ duration_s: 12, ticking: true })] })
  show(<Length isWatched={false} />)
  await act(() => vi.advanceTimersByTimeAsync(1000))
  expect(screen.getByRole('status')).toHaveTextContent('0.5')
})

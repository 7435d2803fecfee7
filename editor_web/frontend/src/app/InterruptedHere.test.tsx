/** The interrupted runs above a page: what is below them is never pushed down. */
import { act, screen } from '@testing-library/react'
import { afterEach, expect, it, vi } from 'vitest'
import { live, server, show } from '../../testing/page'
import { InterruptedHere } from './InterruptedHere'

const NAP = { id: 'r7', behavior: 'nap', started_unix_s: 1000, last_seq: 12 }

function page() {
  return (
    <InterruptedHere behavior="nap" onResumed={vi.fn()}>
      <p>the page</p>
    </InterruptedHere>
  )
}

afterEach(() => {
  vi.useRealTimers()
})

it('shows the page once what stands above it can be drawn whole', async () => {
  let answer: (runs: unknown) => void = () => undefined
  server().on('GET /interrupted', () => new Promise((done) => (answer = done)))
  live()
  show(page())
  expect(screen.queryByText('the page')).toBeNull()
  await act(() => {
    answer([NAP])
    return Promise.resolve()
  })
  await screen.findByText('the page')
  expect(screen.getByRole('listitem', { name: 'Interrupted run of nap' })).toBeVisible()
})

it('shows the page alone where no run of it was interrupted', async () => {
  server().on('GET /interrupted', [{ ...NAP, behavior: 'shift' }])
  live()
  show(page())
  expect(await screen.findByText('the page')).toBeVisible()
  expect(screen.queryByRole('region', { name: 'Interrupted runs' })).toBeNull()
})

it('waits for no answer that does not come', async () => {
  vi.useFakeTimers()
  server().on('GET /interrupted', () => new Promise(() => undefined))
  live()
  show(page())
  expect(screen.queryByText('the page')).toBeNull()
  await act(() => vi.advanceTimersByTimeAsync(1000))
  expect(screen.getByText('the page')).toBeVisible()
})

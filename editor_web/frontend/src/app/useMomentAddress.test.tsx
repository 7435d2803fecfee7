/** The address of a run carries its moment and node, and restores both. */
import { act, render, waitFor } from '@testing-library/react'
import { afterEach, expect, it, vi } from 'vitest'
import { server } from '../../testing/page'
import { leave, runSubject, useTimeline } from '../api/timeline'
import { useMomentAddress } from './useMomentAddress'

const SUBJECT = runSubject('r1', true)
const shown = vi.fn()

function Page({ node }: { readonly node?: string }) {
  useMomentAddress(SUBJECT, node, shown)
  return null
}

function open(address: string, node?: string) {
  shown.mockReset()
  server().on('GET /runs/r1/at', { seq: 3, time_s: 2, nodes: {}, log: [], dropped: 0 })
  history.replaceState(null, '', address)
  return render(<Page {...(node && { node })} />)
}

afterEach(() => act(() => leave(SUBJECT)))

it('restores the time and the node', () => {
  open('/runs/r1#t=2.5&node=root/grasp')
  expect(useTimeline.getState().timeS).toBe(2.5)
  expect(shown.mock.calls).toEqual([['root/grasp']])
})

it('follows the cursor and the selection, and is bare at the present', async () => {
  const page = open('/runs/r1')
  act(() => useTimeline.setState({ timeS: 1.25 }))
  page.rerender(<Page node="root/a" />)
  await waitFor(() => expect(location.hash).toBe('#t=1.25&node=root/a'))
  act(() => useTimeline.setState({ timeS: undefined }))
  page.rerender(<Page />)
  await waitFor(() => expect(location.hash).toBe(''))
  expect(location.pathname).toBe('/runs/r1')
})

it('leaves the address of a behavior alone', () => {
  vi.useFakeTimers()
  open('/behaviors/pick.yaml#t=2.5', 'root/a')
  act(() => useTimeline.setState({ timeS: 1 }))
  act(() => {
    vi.advanceTimersByTime(1000)
  })
  expect([location.hash, shown.mock.calls.length]).toEqual(['#t=2.5', 0])
  vi.useRealTimers()
})

/** How a run failed: where it began, why, what to do, and the way to the moment. */
import { act, screen, waitFor, within } from '@testing-library/react'
import { afterEach, expect, it, vi } from 'vitest'
import { live, run, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { forget, useTimeline } from '../../api/timeline'
import type { RunFailure } from '../../api/types'
import { FailureView } from './FailureView'

const FAILED = run({ status: 'finished', outcome: 'bad' })
const FAILURE: RunFailure = {
  seq: 9,
  time_s: 1.5,
  path: 'root/grasp',
  text: 'root/grasp failed: no contact',
  hint: 'look at the gripper',
  links: [
    { message: 'no contact on either pad', where: 'left', kind: 'GraspFailed', compared: [{ quantity: 'opening', measured: 1.2, unit: 'mm', least: 20, most: 40 }] },
    { message: 'the grasp failed', where: '', kind: 'StateError', compared: [] },
  ],
  steps: [
    { path: 'root', seq: 11, time_s: 1.6, kind: 'exited', level: 'error', text: 'ended with bad', causes: [] },
    { path: 'root/grasp', seq: 9, time_s: 1.5, kind: 'exited', level: 'error', text: 'failed', causes: [] },
  ],
  around: [{ seq: 8, time_s: 1.4, kind: 'log', level: 'info', path: 'root/grasp', text: 'closes', causes: [] }],
}
const chosen = vi.fn()

afterEach(() => {
  act(forget)
  act(() => useTimeline.setState(useTimeline.getInitialState(), true))
})

function sections(): Record<string, string[]> {
  const region = within(screen.getByRole('region', { name: 'How the run failed' }))
  const lists = region.getAllByRole('list')
  const titles = region.getAllByRole('heading', { level: 4 })
  return Object.fromEntries(titles.map((title, at) => [title.textContent ?? '', within(lists[at] ?? document.body).getAllByRole('listitem').map((each) => each.textContent ?? '')]))
}

it('tells where it began, why, and what happened there', async () => {
  server().on('GET /runs/r1/failure', FAILURE)
  live({ runs: [FAILED] })
  show(<FailureView run={FAILED} onShow={chosen} />)
  expect(await screen.findByText('root/grasp failed: no contact')).toBeVisible()
  expect(screen.getByText('It began in root/grasp at 1.50 s')).toBeVisible()
  expect(screen.getByText('look at the gripper')).toBeVisible()
  expect(sections()).toEqual({
    Where: ['root ended with bad at 1.60 s', 'grasp failed at 1.50 s'],
    Why: ['no contact on either padGraspFailed · left', 'so the grasp failedStateError'],
    'What happened there': ['1.40 s closes'],
  })
})

it('leads to the node and the moment', async () => {
  chosen.mockReset()
  server().on('GET /runs/r1/failure', FAILURE).on('GET /runs/r1/at', new Refusal(404, { message: 'gone' }))
  live({ runs: [FAILED] })
  const user = show(<FailureView run={FAILED} onShow={chosen} />)
  await user.click(await screen.findByRole('button', { name: 'Show the moment' }))
  await waitFor(() => expect(chosen.mock.calls).toEqual([['root/grasp']]))
  expect(useTimeline.getState().timeS).toBe(1.5)
})

it.each([
  [undefined, null, 'No run yet'],
  [run(), null, 'The run is active'],
  [FAILED, null, 'This run did not fail'],
  [FAILED, new Refusal(404, { message: 'the journal has no such run' }), 'the journal has no such run'],
])('says what there is to tell of a run that has not failed', async (of, answer, words) => {
  server().on('GET /runs/r1/failure', answer)
  live()
  show(<FailureView run={of} onShow={chosen} />)
  expect(await screen.findByText(words)).toBeVisible()
})

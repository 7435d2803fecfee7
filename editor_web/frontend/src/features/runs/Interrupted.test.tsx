/** Runs whose engine died, and the lists of runs. */
import { screen, waitFor, within } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { live, run, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { InterruptedRun } from '../../api/types'
import { FinishedRuns } from './FinishedRuns'
import { Interrupted } from './Interrupted'
import { RunList } from './RunList'

const NAP: InterruptedRun = {
  id: 'r7',
  behavior: 'nap',
  started_unix_s: 1000,
  last_seq: 12,
}
const ADDRESS = 'POST /interrupted/r7/resume'
const resumed = vi.fn()

function found() {
  return within(screen.getByRole('listitem', { name: 'Interrupted run of nap' }))
}

it('asks what became of states that had begun, and goes on with the answers', async () => {
  resumed.mockReset()
  const questions = [{ path: 'root/only', outcomes: ['done'] }]
  server().on(ADDRESS, ({ body }: { body: { answers: object } }) =>
    'root/only' in body.answers ? { run: 'r7' } : new Refusal(409, { message: 'it asks', questions }),
  )
  const user = show(<Interrupted runs={[NAP]} obstacle={undefined} onResumed={resumed} />)
  expect(found().getByText(/its engine ended in the middle of it, after event 12/)).toBeVisible()
  await user.click(found().getByRole('button', { name: 'Resume' }))
  expect(await found().findByText(/nobody knows whether they had their effect/)).toBeVisible()
  const goOn = found().getByRole('button', { name: 'Go on with these answers' })
  expect(goOn).toBeDisabled()
  const question = within(found().getByRole('radiogroup', { name: 'root/only' }))
  expect(question.getAllByRole('radio')).toHaveLength(2)
  await user.click(question.getByLabelText('It ended with done'))
  await user.click(goOn)
  await waitFor(() => expect(resumed.mock.calls).toEqual([['r7']]))
  expect(server().bodies(ADDRESS).at(-1)).toEqual({ answers: { 'root/only': 'done' }, changed: false })
})

it('says why a run of a changed file is not resumed, and resumes it all the same where that is wanted', async () => {
  resumed.mockReset()
  const refusal = new Refusal(409, { message: 'the behavior nap has changed since', hint: 'agree to the change' })
  server().on(ADDRESS, ({ body }: { body: { changed: boolean } }) => (body.changed ? { run: 'r7' } : refusal))
  const user = show(<Interrupted runs={[NAP]} obstacle={undefined} onResumed={resumed} />)
  await user.click(found().getByRole('button', { name: 'Resume' }))
  expect(await found().findByRole('alert')).toHaveTextContent('the behavior nap has changed since')
  await user.click(found().getByLabelText('Also if its file has changed since'))
  await user.click(found().getByRole('button', { name: 'Resume' }))
  await waitFor(() => expect(resumed.mock.calls).toEqual([['r7']]))
})

it('resumes nothing for those who may look only', () => {
  show(<Interrupted runs={[NAP]} obstacle="you may look only" onResumed={resumed} />)
  expect(found().getByRole('button', { name: 'Resume' })).toBeDisabled()
})

it('lists the runs of the server with how they stand', async () => {
  const opened = vi.fn()
  const ended = { status: 'finished', outcome: 'good', success: true, duration_s: 2.5 }
  live({
    runs: [
      run({ id: 'r3', behavior: 'behaviors/shift.yaml', waits: 'asks' }),
      run({ id: 'r2', behavior: 'behaviors/nap.yaml', waits: 'paused' }),
      run({ id: 'r1', behavior: 'behaviors/day/night.yaml', ...ended }),
    ],
  })
  const user = show(<RunList current="r2" href={(id) => `/runs/${id}`} onOpen={opened} limit={30} />)
  const [shift, nap, night] = screen.getAllByRole('link')
  expect(shift).toHaveTextContent('Waiting for answer')
  expect(nap).toHaveTextContent('Paused')
  expect(nap).toHaveAttribute('aria-current', 'page')
  expect(night).toHaveTextContent('Succeeded: good, 2.50 s')
  await user.click(screen.getByRole('link', { name: /night/ }))
  expect(opened.mock.calls).toEqual([['r1']])
})

it('lists those that ended with their cause, to be compared', async () => {
  const chosen = vi.fn()
  const stopped = run({ id: 'r1', behavior: 'behaviors/nap.yaml', status: 'stopped', cause: 'enough', duration_s: 3 })
  const user = show(<FinishedRuns runs={[stopped]} href={(id) => `/runs/${id}`} onOpen={() => undefined} chosen={[]} onChoose={chosen} />)
  expect(screen.getByRole('listitem')).toHaveTextContent('Stopped')
  expect(screen.getByText('enough')).toBeVisible()
  await user.click(screen.getByRole('checkbox', { name: /Compare nap of/ }))
  expect(chosen.mock.calls).toEqual([['r1', true]])
})

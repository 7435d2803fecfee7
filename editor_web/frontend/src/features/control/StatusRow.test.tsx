/** The row of a run's state: what it says before, during and after the run. */
import { screen, within } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { asks, control, live, run, show, snapshot } from '../../../testing/page'
import type { RunView } from '../../api/types'
import { StatusRow } from './StatusRow'
import { useCommands } from './useCommands'

const RUN = run()
const failed = vi.fn()

function Row({ of }: { readonly of?: RunView }) {
  return <StatusRow run={of} root={null} commands={useCommands(of, undefined)} onShow={() => undefined} onFailure={failed} />
}

function state(): HTMLElement {
  return screen.getByRole('status', { name: 'State of the run' })
}

it('has its place before the first run', () => {
  live()
  show(<Row />)
  expect(state()).toHaveTextContent(/^No run$/)
  expect(screen.getByText('Set the parameters and press Start.')).toBeVisible()
})

it('says why a run is paused', () => {
  const waiting = [asks('root/grasp', { point: 'before', outcome: '', reasons: ['pause'] })]
  live({ run: 'r1', runs: [RUN], control: control({ paused: true, confirmed: true, waiting, breakpoints: [{ path: 'root/grasp' }] }) })
  show(<Row of={RUN} />)
  expect(state()).toHaveTextContent(/^Paused$/)
  expect(screen.getByRole('region', { name: 'Status of the run' })).toHaveTextContent('breakpoint at grasp')
})

it('stands while a run is paused: its time goes on when it does', () => {
  vi.useFakeTimers()
  const told = { run: 'r1', runs: [RUN], now_s: 4, control: control({ paused: true, confirmed: true }) }
  const socket = live({ ...told, ticking: false })
  show(<Row of={RUN} />)
  vi.advanceTimersByTime(3000)
  expect(screen.getByText('4.00 s')).toBeVisible()
  socket.tell(snapshot({ ...told, ticking: true, control: control() }))
  vi.useRealTimers()
})

it('holds question and answers beside the state', () => {
  live({ run: 'r1', runs: [RUN], control: control({ waiting: [asks('root/left'), asks('root/right')] }) })
  show(<Row of={RUN} />)
  expect(state()).toHaveTextContent(/^Waiting for answer$/)
  const row = within(screen.getByRole('region', { name: 'Status of the run' }))
  expect(row.getByText('2 questions')).toBeVisible()
  expect(row.getAllByRole('listitem', { name: /^Question of/ })).toHaveLength(2)
})

it.each([
  [{ status: 'errored', cause: 'division by zero' }, 'Failed'],
  [{ status: 'finished', outcome: 'failed', cause: 'no contact' }, 'Failed'],
  [{ status: 'finished', outcome: 'no_part', cause: 'no part' }, 'Failed: no_part'],
])('says of %j how it failed, and leads to the failure', async (told, words) => {
  failed.mockReset()
  const ended = run(told)
  live({ runs: [ended] })
  const user = show(<Row of={ended} />)
  expect(state()).toHaveTextContent(words)
  expect(screen.getByText(told.cause)).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Show failure' }))
  expect(failed).toHaveBeenCalledOnce()
})

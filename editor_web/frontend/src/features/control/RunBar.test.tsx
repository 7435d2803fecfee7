/** The bar of a run: what is possible, why not otherwise, and what the server is asked for. */
import { fireEvent, screen, waitFor, within } from '@testing-library/react'
import { expect, it } from 'vitest'
import { asks, control, live, run, server, show, snapshot } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { LiveSnapshot, RunView } from '../../api/types'
import { ChangeReport } from './ChangeReport'
import { RefusalLine } from './RefusalLine'
import { RunBar } from './RunBar'
import { StatusRow } from './StatusRow'
import { useCommands } from './useCommands'

const COMMANDS = ['Pause', 'Step into', 'Step over', 'Step out', 'Step back', 'Take control', 'Apply changes', 'Apply changes and preempt']
const RUN = run()
const PAUSED: Partial<LiveSnapshot> = { run: 'r1', runs: [RUN], control: control({ paused: true, confirmed: true }) }

function Bar({ of }: { readonly of?: RunView }) {
  const commands = useCommands(of, undefined)
  return (
    <>
      <RefusalLine />
      <RunBar run={of} commands={commands} hasKeys />
      <StatusRow run={of} root={null} commands={commands} onShow={() => undefined} />
      <ChangeReport commands={commands} />
    </>
  )
}

function button(name: string): HTMLElement {
  return screen.getByRole('button', { name })
}

it('says of every command why it is not possible without a run', () => {
  live()
  show(<Bar />)
  for (const name of COMMANDS) {
    expect(button(name)).toHaveAttribute('aria-disabled', 'true')
    expect(button(name)).toHaveAttribute('title', 'Not possible: no run is active')
  }
  expect(screen.getByLabelText('Autonomy')).toBeDisabled()
})

it('says so also to those who press it, until the words are put away', async () => {
  live()
  const user = show(<Bar />)
  await user.click(button('Pause'))
  expect(screen.getByRole('alert')).toHaveTextContent('Pause was refused: no run is active')
  await user.click(button('Put the refusal away'))
  expect(screen.queryByRole('alert')).toBeNull()
  expect(server().asked.map((each) => each.what)).not.toContain('POST /runs//control/pause')
})

it.each([
  ['Resume', 'resume', {}],
  ['Step into', 'step', { mode: 'into', path: '' }],
  ['Step over', 'step', { mode: 'over', path: '' }],
  ['Step out', 'step', { mode: 'out', path: '' }],
  ['Step back', 'step_back', { path: '' }],
])('asks the server for %s of a paused run', async (name, command, body) => {
  server().on(`POST /runs/r1/control/${command}`, {})
  live(PAUSED)
  const user = show(<Bar of={RUN} />)
  expect(screen.getByRole('status', { name: 'State of the run' })).toHaveTextContent(/^Paused$/)
  await user.click(button(name))
  expect(server().bodies(`POST /runs/r1/control/${command}`)).toEqual([body])
})

it('shows the words of the server when it refuses, and takes them away when it does not', async () => {
  const words = { message: 'the run is not paused', hint: 'pause it first, or set a breakpoint' }
  server().on('POST /runs/r1/control/step', new Refusal(409, words))
  live(PAUSED)
  const user = show(<Bar of={RUN} />)
  await user.click(button('Step over'))
  const alert = await screen.findByRole('alert')
  expect(alert).toHaveTextContent('Step over was refused: the run is not paused – pause it first, or set a breakpoint')
  server().on('POST /runs/r1/control/step', {})
  await user.click(button('Step over'))
  await waitFor(() => expect(alert).not.toBeInTheDocument())
})

it('tells how the run stands and where it waits, as it changes', () => {
  const waiting = [asks('root/first', { point: 'before', outcome: '', required: '', reasons: ['pause'] })]
  const socket = live({ ...PAUSED, control: control({ paused: true, confirmed: false, waiting }) })
  show(<Bar of={RUN} />)
  expect(screen.getByRole('status', { name: 'State of the run' })).toHaveTextContent(/^Pausing$/)
  expect(screen.getByRole('list', { name: 'Nodes that wait' })).toHaveTextContent('root/first before its entry: paused')
  socket.tell(snapshot({ run: 'r1', runs: [RUN], control: control() }))
  expect(screen.getByRole('status', { name: 'State of the run' })).toHaveTextContent(/^Running$/)
  expect(screen.queryByRole('list', { name: 'Nodes that wait' })).toBeNull()
  expect(button('Pause')).not.toHaveAttribute('aria-disabled')
})

it('has a slider of autonomy that says what it means', async () => {
  server().on('POST /runs/r1/control/autonomy', {})
  const socket = live(PAUSED)
  show(<Bar of={RUN} />)
  const slider = screen.getByLabelText('Autonomy')
  expect(slider).toHaveAttribute('aria-valuetext', 'full')
  fireEvent.change(slider, { target: { value: '2' } })
  fireEvent.keyUp(slider)
  await waitFor(() => expect(server().bodies('POST /runs/r1/control/autonomy')).toEqual([{ level: 'high' }]))
  socket.tell(snapshot({ ...PAUSED, control: control({ paused: true, confirmed: true, autonomy: 'high' }) }))
  expect(screen.getByText('Autonomy high: outcomes that require high or full ask.')).toBeVisible()
})

it('follows the autonomy that another console sets', () => {
  const socket = live(PAUSED)
  show(<Bar of={RUN} />)
  socket.tell(snapshot({ ...PAUSED, control: control({ paused: true, confirmed: true, autonomy: 'off' }) }))
  expect(screen.getByText('Autonomy off: every outcome asks.')).toBeVisible()
  expect(screen.getByLabelText('Autonomy')).toHaveAttribute('aria-valuetext', 'off')
  expect(screen.getByLabelText('Autonomy')).toHaveValue('0')
})

it('tells a viewer how the run stands, and why no command is for them', () => {
  live(PAUSED, 'viewer')
  show(<Bar of={RUN} />)
  expect(screen.getByRole('status', { name: 'State of the run' })).toHaveTextContent(/^Paused$/)
  for (const name of ['Resume', 'Step into', 'Take control', 'Apply changes']) {
    expect(button(name)).toHaveAttribute('title', 'Not possible: you may look only; log in with the operator token')
  }
})

it('operates the run of the page and leaves it again', async () => {
  const socket = live(PAUSED)
  const user = show(<Bar of={RUN} />)
  await user.click(button('Take control'))
  expect(socket.sent).toContainEqual({ k: 'operate', run: 'r1' })
  socket.tell(snapshot({ ...PAUSED, control: control({ paused: true, operator: 'attached' }) }))
  expect(button('Take control')).toHaveAttribute('aria-pressed', 'true')
  expect(screen.getByText('You operate this run. If this page is lost, 5 s later the run is paused.')).toBeVisible()
  await user.click(button('Take control'))
  expect(socket.sent.at(-1)).toEqual({ k: 'operate', run: '' })
  expect(screen.getByText('Another page or console operates this run.')).toBeVisible()
})

it.each([
  ['Apply changes', false],
  ['Apply changes and preempt', true],
])('reports what %s has changed', async (name, preempt) => {
  server().on('POST /runs/r1/control/change', { changes: ['root/put is added', 'root/set is removed'] })
  live(PAUSED)
  const user = show(<Bar of={RUN} />)
  await user.click(button(name))
  const report = await screen.findByRole('dialog')
  expect(
    within(report)
      .getAllByRole('listitem')
      .map((each) => each.textContent),
  ).toEqual(['root/put is added', 'root/set is removed'])
  expect(server().bodies('POST /runs/r1/control/change')).toEqual([{ preempt }])
  await user.click(button('Understood'))
  expect(screen.queryByRole('dialog')).toBeNull()
})

it('opens no command while the server does not answer', () => {
  const socket = live(PAUSED)
  show(<Bar of={RUN} />)
  socket.cut()
  expect(button('Resume')).toHaveAttribute('title', 'Not possible: the server does not answer')
})

/** The arms of the cell, those whose path is blocked, and a cell that is lost. */
import { fireEvent, screen, waitFor, within } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, robot, server, show, snapshot } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { BlockedPaths } from './BlockedPaths'
import { LostCell } from './LostCell'
import { RobotStrip } from './RobotStrip'

const REASON = "the world's process ended with signal 9"

function arm() {
  return within(screen.getByRole('listitem', { name: 'Arm left' }))
}

function told(left: Parameters<typeof robot>[0]) {
  return snapshot({ robots: { left: robot(left) } })
}

it('tells what an arm does', () => {
  const socket = live({ robots: { left: robot() } })
  show(<RobotStrip />)
  const state = arm().getByRole('status', { name: 'State of left' })
  expect(state).toHaveTextContent('idle')
  socket.tell(told({ mode: 'moving', activity: 'move_joints' }))
  expect(state).toHaveTextContent('carries outmove_joints')
  socket.tell(told({ mode: 'moving', activity: 'move_joints', separation: 'slowed down: somebody at 0.7 m' }))
  expect(state).toHaveTextContent('slowed down: somebody at 0.7 m')
  socket.tell(told({ mode: 'guiding' }))
  expect(state).toHaveTextContent('led by hand')
})

it('slows an arm down, and shows the speed that somebody else has set', async () => {
  server().on('POST /bus/call', {})
  const socket = live({ robots: { left: robot() } })
  show(<RobotStrip />)
  const speed = arm().getByRole('slider', { name: 'Speed of left' })
  expect(speed).toHaveAttribute('aria-valuetext', '100 %')
  fireEvent.change(speed, { target: { value: '85' } })
  fireEvent.keyUp(speed)
  const address = 'left/set_speed_override'
  await waitFor(() => expect(server().bodies('POST /bus/call')).toEqual([{ address, request: { share: 0.85 } }]))
  socket.tell(told({ speed_override: 0.85 }))
  socket.tell(told({ speed_override: 0.05 }))
  expect(speed).toHaveAttribute('aria-valuetext', '5 %')
})

it('recovers an arm from a reflex, and says why that was not possible', async () => {
  server().on('POST /bus/call', new Refusal(409, { message: 'the arm has not recovered within 1 s', hint: 'clear what pushes it' }))
  const socket = live({ robots: { left: robot() } })
  const user = show(<RobotStrip />)
  expect(arm().queryByRole('button', { name: 'Recover' })).toBeNull()
  socket.tell(told({ mode: 'reflex', error: 'external torque of joint 4' }))
  expect(arm().getByRole('status', { name: 'State of left' })).toHaveTextContent('stopped by a reflex')
  expect(arm().getByText('external torque of joint 4')).toBeVisible()
  await user.click(arm().getByRole('button', { name: 'Recover' }))
  expect(await arm().findByRole('alert')).toHaveTextContent('the arm has not recovered within 1 s – clear what pushes it')
  server().on('POST /bus/call', {})
  await user.click(arm().getByRole('button', { name: 'Recover' }))
  await waitFor(() => expect(arm().queryByRole('alert')).toBeNull())
  expect(server().bodies('POST /bus/call').at(-1)).toEqual({ address: 'left/recover_from_error', request: {} })
  socket.tell(told({}))
  expect(arm().queryByRole('button', { name: 'Recover' })).toBeNull()
})

it('lets a viewer, and a page without a server, change nothing', () => {
  const socket = live({ robots: { left: robot({ mode: 'reflex' }) } }, 'viewer')
  show(<RobotStrip />)
  expect(arm().getByRole('slider', { name: 'Speed of left' })).toBeDisabled()
  expect(arm().getByRole('button', { name: 'Recover' })).toHaveAttribute('title', 'Not possible: you may look only')
  socket.cut()
  expect(arm().getByRole('button', { name: 'Recover' })).toHaveAttribute('title', 'Not possible: the server does not answer')
})

it.each([false, true])('says for what an arm waits and since when; another reason is the same wait', (isLine) => {
  const blocked = (reason: string) => told({ path: { state: 'blocked', reason, length_m: 1, since_s: 940 } })
  const socket = live({ robots: { left: robot({ path: { state: 'moving', reason: '', length_m: 1, since_s: 0 } }) } })
  show(<BlockedPaths isLine={isLine} />)
  expect(screen.queryByRole('list')).toBeNull()
  socket.tell(blocked('left/fore would touch anna/hand'))
  const waiting = screen.getByRole('list', { name: 'Arms with a blocked path' })
  expect(waiting).toHaveTextContent(/left waits: left\/fore would touch anna\/hand, since 1:0\d min/)
  socket.tell(blocked('left/fore would touch anna/fore'))
  expect(waiting).toHaveTextContent(/touch anna\/fore, since 1:0\d min/)
  expect(screen.getByRole('timer')).toHaveAttribute('aria-live', 'off')
  socket.tell(told({}))
  expect(screen.queryByRole('list')).toBeNull()
})

it('says why the cell is lost, and connects it again', async () => {
  server()
    .on('GET /cell/connection', { connected: false, reason: REASON })
    .on('POST /cell/connect', new Refusal(409, { message: 'the world cannot be started', hint: 'see the log of the server' }))
  const socket = live({ robots: { left: robot() } })
  const user = show(<LostCell />)
  expect(screen.queryByRole('alert')).toBeNull()
  socket.tell(told({ mode: 'fault', error: REASON }))
  const banner = await screen.findByRole('alert')
  expect(banner).toHaveTextContent(`The cell is not connected: ${REASON}`)
  await user.click(screen.getByRole('button', { name: 'Connect again' }))
  expect(await screen.findByText(/the world cannot be started – see the log of the server/)).toBeVisible()
  expect(server().bodies('POST /cell/connect')).toEqual([{}])
  server().on('GET /cell/connection', { connected: true, reason: '' }).on('POST /cell/connect', {})
  await user.click(screen.getByRole('button', { name: 'Connect again' }))
  await waitFor(() => expect(screen.queryByRole('alert')).toBeNull())
})

it('offers a viewer no connecting', async () => {
  server().on('GET /cell/connection', { connected: false, reason: REASON })
  live({ robots: { left: robot({ mode: 'disconnected' }) } }, 'viewer')
  show(<LostCell />)
  expect(await screen.findByRole('alert')).toHaveTextContent(REASON)
  expect(screen.queryByRole('button')).toBeNull()
})

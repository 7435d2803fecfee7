/** Real devices: which are is said on every page, a person is asked once before they move, and switches them. */
import { act, screen, waitFor } from '@testing-library/react'
import { expect, it } from 'vitest'
import { server, session, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { answerRealDevices, mayMoveDevices, useRealDevices } from '../../api/realDevices'
import { keepSession } from '../../api/session'
import { devicesWords } from '../../document/devices'
import { DriverSwitch } from './DriverSwitch'
import { RealDevicesQuestion } from './RealDevicesQuestion'

const LEFT = { device: 'left', driver: 'universal_robots', simulated: false }
const TOOL = { device: 'left/gripper', driver: 'robotiq', simulated: true }

it('says which devices are real', () => {
  expect(devicesWords(session())).toBe('')
  expect(devicesWords(session({ devices: [TOOL] }))).toBe('All simulated')
  expect(devicesWords(session({ devices: [LEFT, TOOL] }))).toBe('Real: left')
})

it('asks nobody where all is simulated', async () => {
  keepSession(session({ devices: [TOOL] }))
  await expect(mayMoveDevices()).resolves.toBe(true)
  expect(useRealDevices.getState().answer).toBeUndefined()
})

it('asks once for each opening of the cell, with the devices by name', async () => {
  keepSession(session({ devices: [LEFT, TOOL], epoch: 'first' }))
  const user = show(<RealDevicesQuestion />)
  const asked = mayMoveDevices()
  await user.click(await screen.findByRole('button', { name: 'They may move' }))
  await expect(asked).resolves.toBe(true)
  await expect(mayMoveDevices()).resolves.toBe(true)

  act(() => keepSession(session({ devices: [LEFT], epoch: 'second' })))
  const again = mayMoveDevices()
  expect(await screen.findByRole('list', { name: 'Real devices' })).toHaveTextContent('left, driver universal_robots')
  await user.click(screen.getByRole('button', { name: 'Cancel' }))
  await expect(again).resolves.toBe(false)
})

it('a question that is asked anew answers the one before with no', async () => {
  keepSession(session({ devices: [LEFT] }))
  const first = mayMoveDevices()
  const second = mayMoveDevices()
  await expect(first).resolves.toBe(false)
  answerRealDevices(true)
  await expect(second).resolves.toBe(true)
})

it('switches a device to its driver, and shows why it is refused', async () => {
  server().on('POST /cell/simulation', new Refusal(409, { message: 'run r1 is active' }))
  const user = show(<DriverSwitch session={session({ devices: [LEFT, TOOL] })} />)
  await user.click(screen.getByRole('button', { name: 'Real or simulated' }))
  const open = await screen.findByRole('button', { name: 'Open anew' })
  expect(open).toBeDisabled()
  await user.click(screen.getByRole('switch', { name: /^left is real/ }))
  await user.click(open)
  expect(await screen.findByRole('alert')).toHaveTextContent('run r1 is active')

  server().on('POST /cell/simulation', {})
  await user.click(open)
  await waitFor(() => expect(server().bodies('POST /cell/simulation')).toHaveLength(2))
  expect(server().bodies('POST /cell/simulation').at(-1)).toEqual({ simulated: ['left', 'left/gripper'] })
})

it('offers nothing to a viewer', () => {
  show(<DriverSwitch session={session({ devices: [LEFT], role: 'viewer' })} />)
  expect(screen.queryByRole('button')).toBeNull()
})

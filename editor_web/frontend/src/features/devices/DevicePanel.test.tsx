/** The panel of a device with a driver: what it may do, why not, and how a person enables it. */
import { screen, waitFor, within } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { DeviceDetails, DeviceNow, DeviceState } from '../../api/types'
import { deviceMode, driverOptions } from '../../document/devices'
import { DevicePanel } from './DevicePanel'

const DETAILS: DeviceDetails = {
  device: 'left/gripper',
  address: 'left/hand',
  driver: 'softhand',
  simulated: false,
  can: ['hand commands'],
  cannot: ['torque: it measures none'],
  proven: 'Never run on hardware.',
  page: 'docs/how-to/connect-a-softhand.md',
  enabling: 'Switches the motor on.',
  options: { kind: 'softhand', device: '/dev/ttyUSB7', stale_s: 2 },
  schema: {
    $ref: '#/$defs/Options',
    $defs: {
      Options: {
        type: 'object',
        properties: {
          kind: { enum: ['softhand'] },
          device: { type: 'string', description: 'Serial device' },
          stale_s: { type: 'number', description: 'Until it counts as lost', minimum: 0.1, maximum: 10, default: 0.5 },
          baud: { enum: [460800, 2000000], default: 2000000 },
        },
        required: ['kind', 'device'],
      },
    },
  },
  problem: '',
}
const STATE: DeviceState = {
  driver: 'softhand',
  address: '/dev/ttyUSB7',
  connected: true,
  enabled: false,
  problem: 'over-current',
  fault: 'over-current',
  mode: 'fault',
  firmware: '',
  safety: '',
  last_cause: 'over-current',
  last_cause_unix_s: 1000,
  enabled_by: 'Anna',
  enabled_for: 'the area is clear',
}

function now(told: Partial<DeviceState> = {}): DeviceNow {
  return { state: { ...STATE, ...told }, link: { readings_hz: 49.6, longest_gap_s: 0.03, age_s: 0.8, speed_scaling: 0.7 } }
}

function panel(device: DeviceNow | undefined, role = 'operator', details = DETAILS) {
  live({}, role)
  return show(<DevicePanel details={details} now={device} />)
}

it('says what the device may do, what has stopped it, who has enabled it and how fresh its readings are', () => {
  panel(now())
  const table = screen.getByRole('table', { name: 'Device left/hand' })
  for (const words of [
    'fault',
    'over-current',
    'Anna: the area is clear',
    'the device does not report it',
    '70 %',
    '50 readings per second',
  ]) {
    expect(table).toHaveTextContent(words)
  }
  expect(table).toHaveTextContent('the last one is 0.80 s old')
  expect(screen.getByRole('table', { name: 'Driver of left/gripper' })).toHaveTextContent('Never run on hardware.')
})

it('every mode has words and a look of its own', () => {
  const modes = (['reading', 'enabled', 'stopped', 'fault', 'lost'] as const).map((mode) => deviceMode({ mode }))
  expect(new Set(modes.map((each) => each.words)).size).toBe(5)
  expect(new Set(modes.map((each) => each.look)).size).toBe(5)
})

it('enables it with a reason, in the name of the person, at its address on the bus', async () => {
  server().on('POST /bus/call', { enabled: true })
  const user = panel(now())
  await user.click(screen.getByRole('button', { name: 'Enable left/hand…' }))
  const dialog = await screen.findByRole('dialog', { name: 'Enable left/hand?' })
  expect(dialog).toHaveTextContent('Switches the motor on.')
  expect(within(dialog).getByRole('button', { name: 'Enable' })).toBeDisabled()
  await user.type(within(dialog).getByRole('textbox', { name: /Reason/ }), 'the cable is back')
  await user.click(within(dialog).getByRole('button', { name: 'Enable' }))
  await waitFor(() => expect(screen.queryByRole('dialog')).toBeNull())
  expect(server().bodies('POST /bus/call')).toEqual([
    { address: 'left/hand/enable_device', request: { reason: 'the cable is back', by: '' } },
  ])
})

it('shows why it was refused', async () => {
  server().on('POST /bus/call', new Refusal(422, { message: 'left/hand is commanded by run r1' }))
  const user = panel(now())
  await user.click(screen.getByRole('button', { name: 'Enable left/hand…' }))
  await user.type(await screen.findByRole('textbox', { name: /Reason/ }), 'go on{Enter}')
  expect(await screen.findByRole('alert')).toHaveTextContent('left/hand is commanded by run r1')
})

it('a viewer, and a lost device, are told why it cannot be enabled', async () => {
  const user = panel(now(), 'viewer')
  await user.click(screen.getByRole('button', { name: 'Enable left/hand…' }))
  expect(screen.queryByRole('dialog')).toBeNull()
  expect(screen.getByText(/only who is logged in as operator/)).toBeVisible()
})

it('a lost device is connected before it is enabled', () => {
  panel(now({ connected: false, mode: 'lost' }))
  expect(screen.getByText(/connect the cell again first/)).toBeVisible()
})

it('an enabled device, and a simulated one, offer nothing to enable', () => {
  panel(now({ enabled: true, mode: 'enabled', problem: '', fault: '' }))
  expect(screen.queryByRole('button', { name: /Enable/ })).toBeNull()
})

it('a simulated device shows its driver and options, and no state', () => {
  panel(undefined, 'operator', { ...DETAILS, simulated: true })
  expect(screen.queryByRole('region', { name: 'Real device' })).toBeNull()
  expect(screen.getByRole('table', { name: 'Options of softhand' })).toHaveTextContent('Until it counts as lost; 0.1 – 10')
})

it('reads the options by their schema: value, unit, default and range', () => {
  const [device, stale, baud] = driverOptions(DETAILS)
  expect(device).toMatchObject({ name: 'device', value: '/dev/ttyUSB7', preset: '', isSet: true })
  expect(stale).toMatchObject({ value: '2', unit: 's', preset: '0.5', range: '0.1 – 10' })
  expect(baud).toMatchObject({ value: '2000000', isSet: false, range: '460800, 2000000' })
})

it('describes a composed option by the shape that was chosen', () => {
  const wire = (kind: string) => ({
    type: 'object',
    title: kind,
    description: `By ${kind}.`,
    properties: { kind: { enum: [kind] }, host: {} },
  })
  const connection = { anyOf: [{ $ref: '#/$defs/serial' }, { $ref: '#/$defs/tcp' }] }
  const root = { type: 'object', properties: { kind: { enum: ['robotiq'] }, connection }, required: ['connection'] }
  const schema = { $ref: '#/$defs/Options', $defs: { Options: root, serial: wire('serial'), tcp: wire('tcp') } }
  const [option] = driverOptions({ options: { connection: { kind: 'tcp', host: 'here' } }, schema })
  expect(option).toMatchObject({ value: 'kind: tcp, host: here', description: 'By tcp.' })
})

/** Numbers of a recording are chosen as those of the bus are; what is not recorded is said. */
import { screen } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { RecordedPlots } from './RecordedPlots'

const SOURCES = [{ address: '/runs/r1', label: '', startS: 0 }]
const FIELDS = {
  topics: [{ topic: 'left/gripper', type: 'GripperState', fields: [{ path: 'width_m', label: 'width_m', unit: 'm' }] }],
  from_s: 0,
  until_s: 4,
}

beforeEach(() => localStorage.removeItem('flexcell.plots'))

it('draws what is chosen, and keeps it for the live plots', async () => {
  server().on('GET /runs/r1/fields', FIELDS)
  const user = show(<RecordedPlots sources={SOURCES} durationS={4} cursorS={1.5} onGo={vi.fn()} />)
  expect(await screen.findByText('Nothing is selected')).toBeVisible()
  expect(screen.getByRole('button', { name: 'CSV' })).toBeDisabled()
  await user.click(screen.getByRole('button', { name: 'left/gripper' }))
  await user.click(screen.getByRole('checkbox', { name: 'width_m of left/gripper' }))
  expect(screen.getByRole('slider', { name: /^1 recorded curves from 0.00 to 4.00 s/ })).toBeVisible()
  expect(screen.getByText('1.50 s')).toBeVisible()
  expect(screen.getByRole('button', { name: 'PNG' })).toBeEnabled()
  expect(localStorage.getItem('flexcell.plots')).toBe('["left/gripper:width_m"]')
})

it('moves the cursor and zooms by keys, and keeps the cursor inside the run', async () => {
  localStorage.setItem('flexcell.plots', '["left/gripper:width_m"]')
  server().on('GET /runs/r1/fields', FIELDS)
  const gone = vi.fn()
  const user = show(<RecordedPlots sources={SOURCES} durationS={4} cursorS={4} onGo={gone} />)
  const plot = await screen.findByRole('slider')
  plot.focus()
  await user.keyboard('{ArrowRight}{ArrowLeft}')
  expect(gone.mock.calls.map(([timeS]: number[]) => timeS?.toFixed(2))).toEqual(['4.00', '3.96'])
  await user.keyboard('+')
  expect(screen.getByRole('slider', { name: /from 0.80 to 4.00 s/ })).toBe(plot)
  await user.click(screen.getByRole('button', { name: 'Whole' }))
  expect(screen.getByRole('slider', { name: /from 0.00 to 4.00 s/ })).toBe(plot)
})

it('says that a run was not recorded', async () => {
  server().on('GET /runs/r1/fields', new Refusal(404, { message: 'there is no recording of this run' }))
  show(<RecordedPlots sources={SOURCES} durationS={4} cursorS={undefined} onGo={vi.fn()} />)
  expect(await screen.findByText(/there is no recording of this run/)).toBeVisible()
})

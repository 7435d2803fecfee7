/** The form that starts a run: its fields, what is wrong with them, and what is sent. */
import { screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { control, live, run, server, session, show, snapshot } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { BehaviorView, RunStarted, StartBody } from '../../api/types'
import { useRefusal } from '../../api/refusal'
import { ParameterForm } from './ParameterForm'
import { StartButton } from './StartButton'
import { StartProvider } from './StartProvider'

const SHIFT: BehaviorView = {
  id: 'behaviors/shift.yaml',
  name: 'shift',
  description: '',
  parameters: [
    { name: 'part', schema: { type: 'string', title: 'Part' }, required: true },
    { name: 'speed', schema: { type: 'number', title: 'Speed', minimum: 0.05, maximum: 1, default: 0.3, unit: 'm/s' }, required: false },
    { name: 'cycles', schema: { type: 'integer', title: 'Cycles', minimum: 1, default: 1 }, required: false },
    { name: 'verify', schema: { type: 'boolean', title: 'Verify', default: true }, required: false },
  ],
  findings: [],
  graph: null,
  view: {},
  success: [],
  fit: { cell: '', obstacle: '' },
}
const DEFAULTS = { part: 'hca_1', speed: 0.3, cycles: 1, verify: true }
const started = vi.fn()
const wrong = vi.fn()

interface FormProps {
  readonly of?: BehaviorView
  readonly obstacle?: string
  readonly shown?: string
  /** Is the form in the document, or the button alone? */
  readonly isDrawn?: boolean
}

function Form({ of = SHIFT, obstacle, shown, isDrawn = true }: FormProps) {
  return (
    <StartProvider behavior={of} onStarted={started}>
      {isDrawn && <ParameterForm behavior={of} place="In the cell bench." terminal="flexcell run" run={shown} />}
      <StartButton obstacle={obstacle} onWrong={wrong} />
    </StartProvider>
  )
}

function sent(): StartBody[] {
  return server().bodies('POST /runs') as StartBody[]
}

beforeEach(() => {
  started.mockReset()
  wrong.mockReset()
  server().on('POST /runs', { run: 'r1' }).on('GET /cell/connection', { connected: true, reason: '' })
})

it('sends what stands in its fields, with the defaults of the document', async () => {
  const user = show(<Form />)
  await user.type(screen.getByLabelText(/^Part/), 'hca_1')
  await user.clear(screen.getByLabelText(/^Speed/))
  await user.type(screen.getByLabelText(/^Speed/), '0.5')
  await user.click(screen.getByLabelText('Verify'))
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() => expect(started).toHaveBeenCalled())
  expect(sent()).toMatchObject([{ behavior: SHIFT.id, parameters: { ...DEFAULTS, speed: 0.5, verify: false }, inputs: {}, seed: null }])
})

it('says at a field what is wrong with it, and sends nothing until it is right', async () => {
  const user = show(<Form />)
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(screen.getByText('A value is required')).toBeVisible()
  expect(screen.getByLabelText(/^Part/)).toHaveAttribute('aria-invalid', 'true')
  await user.type(screen.getByLabelText(/^Part/), 'hca_1')
  expect(screen.queryByText('A value is required')).toBeNull()
  await user.clear(screen.getByLabelText(/^Speed/))
  await user.type(screen.getByLabelText(/^Speed/), '3')
  expect(screen.getByText('Must be 0.05 – 1')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(sent()).toEqual([])
})

it('starts where the form is not drawn yet, or no more', async () => {
  const user = show(<Form of={{ ...SHIFT, parameters: [] }} isDrawn={false} />)
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() => expect(started).toHaveBeenCalledOnce())
  expect(sent()).toHaveLength(1)
})

it('starts nothing of which the parameters cannot be read, and says so', async () => {
  const user = show(<Form of={JSON.parse(JSON.stringify({ ...SHIFT, parameters: null })) as BehaviorView} isDrawn={false} />)
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(useRefusal.getState().refusal?.message).toBe('its parameters cannot be read')
  expect(sent()).toEqual([])
})

it('brings the form forward when a value is wrong, and only then', async () => {
  const user = show(<Form />)
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() => expect(wrong).toHaveBeenCalledOnce())
  await user.type(screen.getByLabelText(/^Part/), 'hca_1')
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() => expect(started).toHaveBeenCalledOnce())
  expect(wrong).toHaveBeenCalledOnce()
})

it('puts the words of the engine at the field that they are about', async () => {
  const words = { message: "no entry is named 'ghost'", where: 'parameters.part', hint: 'see the store' }
  server().on('POST /runs', new Refusal(422, words))
  const user = show(<Form />)
  await user.type(screen.getByLabelText(/^Part/), 'ghost')
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(await screen.findByText("no entry is named 'ghost' (see the store)")).toBeVisible()
  expect(screen.getByLabelText(/^Part/)).toHaveAttribute('aria-invalid', 'true')
  expect(started).not.toHaveBeenCalled()
  expect(wrong).toHaveBeenCalledOnce()
})

it('says beside the button what is about no field, and asks whether the cell is lost', async () => {
  server().on('POST /runs', new Refusal(409, { message: 'the cell is not connected', hint: 'flexcell cell connect' }))
  const user = show(<Form of={{ ...SHIFT, parameters: [] }} />)
  expect(screen.getByText('This behavior has no parameters.')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() =>
    expect(useRefusal.getState().refusal).toEqual({ what: 'Start', message: 'the cell is not connected', hint: 'flexcell cell connect' }),
  )
  expect(server().asked.map((each) => each.what)).toContain('GET /cell/connection')
})

it('does nothing while there is an obstacle', async () => {
  const user = show(<Form of={{ ...SHIFT, parameters: [] }} obstacle="This behavior is running" />)
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(sent()).toEqual([])
})

it('begins with the userdata that is written as a JSON object, and with nothing else', async () => {
  const user = show(<Form of={{ ...SHIFT, parameters: [] }} />)
  await user.click(screen.getByRole('button', { name: 'Initial userdata' }))
  const data = screen.getByLabelText('Userdata')
  await user.type(data, '[[1]')
  expect(screen.getByText('This is not a JSON object')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(sent()).toEqual([])
  await user.clear(data)
  await user.type(data, '{{"value": 9}')
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(sent().map((body) => body.inputs)).toEqual([{ value: 9 }])
})

it('takes over parameters, userdata and seed of the run that is shown', async () => {
  const origin: RunStarted = {
    event: 'run_started',
    seq: 1,
    time_s: 0,
    behavior: 'shift',
    document: 'd1',
    parameters: { part: 'hca_7', speed: 0.25, gone: 1 },
    seed: 77,
    clock: 'real',
    inputs: { value: 5 },
  }
  server().on('GET /runs/r0/events', { events: [origin], last: 1 })
  const user = show(<Form shown="r0" />)
  await user.click(screen.getByRole('button', { name: 'Same as the shown run' }))
  await waitFor(() => expect(screen.getByLabelText(/^Part/)).toHaveValue('hca_7'))
  expect(screen.getByLabelText(/^Speed/)).toHaveValue('0.25')
  await user.click(screen.getByRole('button', { name: 'Start' }))
  const parameters = { ...DEFAULTS, part: 'hca_7', speed: 0.25 }
  expect(sent()).toMatchObject([{ parameters, inputs: { value: 5 }, seed: 77 }])
})

it('sends a seed that is typed', async () => {
  const user = show(<Form of={{ ...SHIFT, parameters: [] }} />)
  await user.click(screen.getByRole('button', { name: 'Repeatability' }))
  await user.type(screen.getByLabelText('Seed'), '42')
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(sent().map((body) => body.seed)).toEqual([42])
})

it('begins paused where that is wanted', async () => {
  const user = show(<Form of={{ ...SHIFT, parameters: [] }} />)
  await user.click(screen.getByRole('button', { name: 'Operation' }))
  await user.click(screen.getByLabelText('Begin paused'))
  await user.click(screen.getByRole('button', { name: 'Start' }))
  expect(sent()).toMatchObject([{ supervision: { start_paused: true, demand_operator: false }, breakpoints: false }])
})

it('operates a run below full autonomy from this page before its first node is entered', async () => {
  server().on('GET /session', session()).on('POST /runs/r1/control/resume', {})
  const socket = live({ run: 'r1', runs: [run()], control: control({ paused: true }) })
  const user = show(<Form of={{ ...SHIFT, parameters: [] }} />)
  await user.click(screen.getByRole('button', { name: 'Operation' }))
  await user.click(screen.getByRole('combobox', { name: 'Autonomy at the start' }))
  await user.click(within(screen.getByRole('listbox', { name: 'Autonomy at the start' })).getByText('high'))
  expect(screen.getByLabelText(/^Take control of it from this page/)).toBeChecked()
  await user.click(screen.getByRole('combobox', { name: 'When the operator is lost' }))
  await user.click(within(screen.getByRole('listbox', { name: 'When the operator is lost' })).getByText('stop the run'))
  await user.clear(screen.getByLabelText('After'))
  await user.type(screen.getByLabelText('After'), '7')
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() => expect(socket.sent).toContainEqual({ k: 'operate', run: 'r1' }))
  const supervision = { autonomy: 'high', start_paused: true, loss_policy: 'stop', loss_timeout_s: 7 }
  expect(sent()).toMatchObject([{ supervision }])
  expect(server().bodies('POST /runs/r1/control/resume')).toEqual([])
  socket.tell(snapshot({ run: 'r1', runs: [run()], control: control({ paused: true, operator: 'attached' }) }))
  await waitFor(() => expect(server().bodies('POST /runs/r1/control/resume')).toEqual([{}]))
})

it('says why a behavior of another cell cannot be started here', () => {
  show(<Form of={{ ...SHIFT, fit: { cell: 'lathe', obstacle: 'it is written for the cell lathe' } }} obstacle="no" />)
  expect(screen.getByRole('alert')).toHaveTextContent('It cannot be started hereit is written for the cell lathe')
})

const NAMING: BehaviorView = {
  ...SHIFT,
  parameters: [
    { name: 'arm', schema: { type: 'string', title: 'Arm', cell_name: 'robot', default: 'left' }, required: false },
    { name: 'place', schema: { type: 'string', title: 'Place', entry: 'joints', default: '' }, required: false },
  ],
}

it('offers what the cell and its store have for a parameter that names it, and takes another name', async () => {
  server().on('GET /catalogue', {
    states: [],
    containers: [],
    behaviors: [],
    names: { robot: ['left', 'right'] },
    entries: [
      { kind: 'joints', name: 'home' },
      { kind: 'pose', name: 'tray' },
    ],
  })
  const user = show(<Form of={NAMING} />)
  const arm = await screen.findByRole('combobox', { name: /^Arm/ })
  await user.click(arm)
  await user.click(await screen.findByRole('option', { name: 'right' }))
  const place = screen.getByRole('combobox', { name: /^Place/ })
  await user.click(place)
  expect(await screen.findByRole('option', { name: 'home' })).toBeVisible()
  expect(screen.queryByRole('option', { name: 'tray' })).toBeNull()
  await user.type(place, 'shelf')
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() => expect(started).toHaveBeenCalled())
  expect(sent()).toMatchObject([{ parameters: { arm: 'right', place: 'shelf' } }])
})

it('does not ask for the names of the cell where no parameter names anything', () => {
  show(<Form />)
  expect(screen.getByLabelText(/^Part/)).not.toHaveAttribute('aria-haspopup')
  expect(server().unanswered).toEqual([])
})

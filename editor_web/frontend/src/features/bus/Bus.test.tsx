/** The skill bus: what there is, forms for what can be sent, and what becomes of it. */
import { screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { live, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { BusListing, BusMetricsFrame, GoalInfo, GoalStreamLine } from '../../api/types'
import { Bus } from './Bus'

const BOARD: BusListing = {
  shape: 's1',
  topics: [
    { name: 'plant/joint_state', type: 'JointState', doc: 'Measured joint state of one `robot`', takes_commands: false },
    { name: 'plant/lamp', type: 'Lamp', doc: '', takes_commands: true },
  ],
  skills: [
    { kind: 'service', name: 'plant/add_numbers', type: 'AddNumbers', doc: '', answer: 'Sum' },
    { kind: 'action', name: 'plant/travel', type: 'Travel', doc: '', answer: 'TravelResult' },
  ],
  parameters: [{ name: 'plant/stiffness', doc: '', value: 300, schema: { type: 'number', minimum: 0, maximum: 900 } }],
}
const FORMS: Record<string, object> = {
  'plant/add_numbers': { left: { type: 'number' }, right: { type: 'number', default: 1 } },
  'plant/travel': { target: { type: 'object', default: { xyz: [0, 0, 0] } }, speed: { type: 'number', default: 0.5 } },
  'plant/lamp': { brightness: { type: 'number' } },
}
const REQUIRED: Record<string, string[]> = { 'plant/add_numbers': ['left'], 'plant/travel': [], 'plant/lamp': ['brightness'] }
const TRAFFIC: BusMetricsFrame = {
  k: 'traffic',
  shape: 's1',
  topics: {
    'plant/joint_state': { rate_hz: 124.6, age_s: 0.01, on_demand: false, subscribers: 1 },
    'plant/lamp': { rate_hz: 0, age_s: null, on_demand: false, subscribers: 0 },
  },
  leases: [],
  goals: [],
}

beforeEach(() => {
  server().on('GET /bus/board', BOARD)
  server().on('GET /bus/form', ({ query }: { query: URLSearchParams }) => {
    const name = query.get('address') ?? query.get('topic') ?? ''
    return { name, schema: { type: 'object', properties: FORMS[name], required: REQUIRED[name] } }
  })
})

/** The bus with one kind in front. */
async function at(kind: string, role = 'operator') {
  live({}, role)
  const user = show(<Bus session={{ role }} />)
  const socket = server().socket('/data')
  socket.accept()
  socket.tell(TRAFFIC)
  await user.click(await screen.findByLabelText(kind))
  return { user, socket }
}

function row(name: RegExp): HTMLElement {
  return screen.getByRole('button', { name })
}

/** The course of a goal, line by line as the server writes it. */
function streamed() {
  let writer: ReadableStreamDefaultController<Uint8Array> | undefined
  const body = new ReadableStream<Uint8Array>({ start: (controller) => void (writer = controller) })
  return {
    answer: new Response(body),
    tell: (line: GoalStreamLine) => writer?.enqueue(new TextEncoder().encode(`${JSON.stringify(line)}\n`)),
    end: () => writer?.close(),
  }
}

it('shows topics with type, rate and age, and the newest message of the one that is chosen', async () => {
  const { user, socket } = await at('Topics')
  expect(row(/^joint_state/)).toHaveTextContent('joint_stateJointState125 Hznow')
  expect(row(/^lamp/)).toHaveTextContent('never')
  await user.click(row(/^joint_state/))
  expect(socket.sent.at(-1)).toEqual({ k: 'look', traffic: true, topic: 'plant/joint_state' })
  const detail = screen.getByRole('region', { name: 'plant/joint_state' })
  expect(detail).toHaveTextContent('Measured joint state of one robot')
  socket.tell({ k: 'message', topic: 'plant/joint_state', at_s: 1, value: { position_rad: [0, 0.5] }, problem: '' })
  expect(screen.getByRole('list', { name: 'Latest message of plant/joint_state' })).toHaveTextContent('[0, 0.5]')
  socket.tell({ k: 'message', topic: 'plant/joint_state', at_s: 2, value: { position_rad: [0.9, -0.3] }, problem: '' })
  expect(screen.getByRole('list', { name: 'Latest message of plant/joint_state' })).toHaveTextContent('[0.9, -0.3]')
  socket.tell({ k: 'message', topic: 'plant/joint_state', at_s: 2, value: null, problem: 'it is on demand' })
  expect(detail).toHaveTextContent('There is no message: it is on demand.')
})

it('finds entries by their words', async () => {
  const { user } = await at('Topics')
  await user.type(screen.getByLabelText('Find on the bus'), 'jointstate')
  expect(screen.queryByRole('button', { name: /^lamp/ })).toBeNull()
  await user.type(screen.getByLabelText('Find on the bus'), ' no such thing')
  expect(screen.getByText('Nothing matches')).toBeVisible()
  await user.click(row(/^Clear/))
  expect(row(/^lamp/)).toBeVisible()
})

it('calls a service from its form, and says what is missing before anything is sent', async () => {
  server().on('POST /bus/call', { sum: 42 })
  const { user } = await at('Services')
  await user.click(row(/^add_numbers/))
  const form = within(await screen.findByRole('form', { name: 'Request to plant/add_numbers' }))
  expect(form.getByLabelText(/^right/)).toHaveValue('1')
  await user.click(form.getByRole('button', { name: 'Call' }))
  expect(form.getByText('A value is required')).toBeVisible()
  expect(server().bodies('POST /bus/call')).toEqual([])
  await user.type(form.getByLabelText(/^left/), '41')
  await user.click(form.getByRole('button', { name: 'Call' }))
  expect(await screen.findByRole('status', { name: 'Course of the request' })).toHaveTextContent('Answered')
  expect(screen.getByRole('list', { name: 'Answer' })).toHaveTextContent('42')
  expect(server().bodies('POST /bus/call')).toEqual([{ address: 'plant/add_numbers', request: { left: 41, right: 1 } }])
  server().on('POST /bus/call', new Refusal(409, { message: 'these numbers are too large', hint: 'add smaller ones' }))
  await user.click(form.getByRole('button', { name: 'Call' }))
  expect(await form.findByRole('alert')).toHaveTextContent('these numbers are too large – add smaller ones')
})

it('shows the course of a goal, and cancels it', async () => {
  const goal = streamed()
  server()
    .on('POST /bus/goals', () => goal.answer)
    .on('POST /bus/goals/g1/cancel', {})
  const { user } = await at('Actions')
  await user.click(row(/^travel/))
  expect(screen.getByText(/This may move the robot/)).toBeVisible()
  const form = within(await screen.findByRole('form', { name: 'Request to plant/travel' }))
  expect(form.getByLabelText(/^target/)).toHaveTextContent('"xyz"')
  await user.clear(form.getByLabelText(/^target/))
  await user.type(form.getByLabelText(/^target/), '{{"xyz": [[0.4, 0, 0.3]}')
  await user.click(form.getByRole('button', { name: 'Send goal' }))
  goal.tell({ k: 'sent', goal: 'g1' })
  goal.tell({ k: 'course', status: 'active', feedback: { progress: 0.75 } })
  const course = await screen.findByRole('status', { name: 'Course of the request' })
  await waitFor(() => expect(course).toHaveTextContent('Active'))
  expect(within(course).getByRole('progressbar')).toHaveAttribute('aria-valuenow', '75')
  expect(form.getByLabelText(/^speed/)).toBeDisabled()
  expect(server().bodies('POST /bus/goals')).toEqual([{ address: 'plant/travel', request: { target: { xyz: [0.4, 0, 0.3] }, speed: 0.5 } }])
  await user.click(screen.getByRole('button', { name: 'Cancel goal' }))
  expect(server().bodies('POST /bus/goals/g1/cancel')).toEqual([{}])
  goal.tell({ k: 'end', end: { status: 'canceled', result: null, cause: null } })
  goal.end()
  await waitFor(() => expect(course).toHaveTextContent('Cancelled, the device is at rest'))
  expect(form.getByLabelText(/^speed/)).toBeEnabled()
})

it('tells who holds what, for whom and for how long', async () => {
  const { socket } = await at('Leases')
  expect(screen.getByText('No leases')).toBeVisible()
  const lease = { resource: 'plant', run: 'run-7', node: 'root/move', goal: 'g1', held_s: 2 }
  const goal: GoalInfo = { id: 'g1', address: 'plant/travel', run: 'run-7', node: 'root/move', status: 'active', feedback: null }
  socket.tell({ ...TRAFFIC, leases: [lease], goals: [goal] })
  expect(screen.getByRole('row', { name: /^plant/ })).toHaveTextContent('plantrun run-7root/moveplant/travel (active)2.00 s')
})

it('sets a parameter within its limits', async () => {
  server().on('PUT /bus/parameter', 450)
  const { user } = await at('Parameters')
  await user.click(row(/^stiffness/))
  const field = within(await screen.findByRole('form', { name: 'Set plant/stiffness' })).getByRole('textbox')
  expect(field).toHaveValue('300')
  await user.clear(field)
  await user.type(field, '1200')
  await user.click(screen.getByRole('button', { name: 'Set' }))
  expect(screen.getByText('Must be 0 – 900')).toBeVisible()
  expect(server().bodies('PUT /bus/parameter')).toEqual([])
  await user.clear(field)
  await user.type(field, '450')
  await user.click(screen.getByRole('button', { name: 'Set' }))
  await waitFor(() => expect(screen.getByRole('list', { name: 'Value of plant/stiffness' })).toHaveTextContent('450'))
  expect(server().bodies('PUT /bus/parameter')).toEqual([{ name: 'plant/stiffness', value: 450 }])
})

it('publishes on a topic that takes commands', async () => {
  server().on('POST /bus/publish', undefined)
  const { user } = await at('Topics')
  await user.click(row(/^lamp/))
  await user.type(await screen.findByLabelText(/^brightness/), '0.5')
  await user.click(screen.getByRole('button', { name: 'Publish' }))
  await waitFor(() => expect(server().bodies('POST /bus/publish')).toEqual([{ topic: 'plant/lamp', message: { brightness: 0.5 } }]))
})

it('lets a viewer see everything and send nothing', async () => {
  const { user } = await at('Actions', 'viewer')
  await user.click(row(/^travel/))
  expect(screen.getByText(/You may look only/)).toBeVisible()
  expect(await screen.findByRole('button', { name: 'Send goal' })).toBeDisabled()
})

it('leads back to the list', async () => {
  const { user } = await at('Actions')
  await user.click(row(/^travel/))
  await user.click(screen.getByRole('button', { name: 'Back to the list' }))
  expect(screen.getByText('Nothing is selected')).toBeVisible()
})

it('comes back when the list could not be read once', async () => {
  server().on('GET /bus/board', new Refusal(503, { message: 'the bus is starting' }))
  live()
  show(<Bus session={{ role: 'operator' }} />)
  const socket = server().socket('/data')
  socket.accept()
  socket.tell(TRAFFIC)
  expect(await screen.findByText('the bus is starting')).toBeVisible()
  server().on('GET /bus/board', { ...BOARD, shape: 's2' })
  socket.tell({ ...TRAFFIC, shape: 's2' })
  expect(await screen.findByRole('button', { name: /^lamp/ })).toBeVisible()
})

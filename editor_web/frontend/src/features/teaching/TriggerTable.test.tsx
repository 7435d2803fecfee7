/** Teaching: triggers as a table and as YAML, tags of entries, and why an arm cannot be moved. */
import { fireEvent, screen, waitFor, within } from '@testing-library/react'
import { afterEach, beforeEach, expect, it } from 'vitest'
import { armInfo, live, server, session, show } from '../../../testing/page'
import { Refusal, type FakeSocket } from '../../../testing/server'
import { connectTeach } from '../../api/teaching'
import type { ArmLive, EntryChanged, Trigger, TriggerStatus } from '../../api/types'
import { EntryDetails } from './EntryDetails'
import { JogPanel } from './JogPanel'
import { TriggerTable } from './TriggerTable'

const LEFT = armInfo({ tool: 'hand' })
const SAVE: Trigger = {
  trig_name: 'Joints',
  robot_ns: 'left',
  trig_topic: 'buttons/keyboard/previous',
  trig_type: 'rising_edge',
  trig_callback: 'joint_save',
  trig_value: true,
  field: '',
  joint_dmp_N: 0,
  source_frame: '',
  target_frame: 'world',
}
const SET = 'teach/set_triggers'
let disconnect: () => void = () => undefined
/** What `/bus/call` answers, by address. */
let answers: Record<string, (request: unknown) => unknown> = {}

function taught(role = 'operator'): FakeSocket {
  server().on('GET /session', session({ role }))
  live({}, role)
  disconnect = connectTeach()
  const socket = server().socket('/teach/live')
  socket.accept()
  socket.tell({ k: 'arms', arms: [LEFT], can_push: false, frames: ['world'] })
  socket.tell({ k: 'ready', arm: 'left', ready: true, reason: '' })
  return socket
}

function hand(...triggers: Partial<TriggerStatus>[]): object {
  const full = triggers.map((each) => ({ trigger: SAVE, message_type: 'Button', pressed: false, fault: '', ...each }))
  return { k: 'hand', status: { triggers: full, captures: [], recording: [], guided: [], said: '' } }
}

function arm(told: Partial<ArmLive> = {}): object {
  const now = { mode: 'idle', activity: '', error: '', joints: [0, 0.5], tool_pose: [0.4, 0, 0.3, 0, 0, 0, 1], tool: null, ...told }
  return { k: 'now', arms: { left: now } }
}

function calls(address: string): unknown[] {
  const bodies = server().bodies('POST /bus/call') as { address: string; request: unknown }[]
  return bodies.filter((each) => each.address === address).map((each) => each.request)
}

beforeEach(() => {
  answers = { [SET]: () => ({}) }
  server().on('POST /bus/call', ({ body }: { body: { address: string; request: unknown } }) => answers[body.address]?.(body.request))
})
afterEach(() => disconnect())

it('adds a trigger, with the words of the Helping Hand', async () => {
  const socket = taught()
  const user = show(<TriggerTable arms={['left']} />)
  socket.tell(hand())
  expect(screen.getByText('No button does anything yet')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Add a trigger' }))
  const form = within(screen.getByRole('form', { name: 'Trigger' }))
  await user.type(form.getByLabelText('Name'), 'Pose')
  await user.clear(form.getByLabelText('Topic'))
  await user.type(form.getByLabelText('Topic'), 'buttons/keyboard/play_pause')
  await user.selectOptions(form.getByLabelText('Callback'), 'pose_save')
  await user.click(form.getByRole('button', { name: 'Keep the trigger' }))
  const made = { ...SAVE, trig_name: 'Pose', trig_topic: 'buttons/keyboard/play_pause', trig_callback: 'pose_save' }
  await waitFor(() => expect(calls(SET)).toEqual([{ triggers: [made] }]))
  socket.tell(hand({ trigger: { ...SAVE, trig_name: 'Pose', trig_callback: 'pose_save' } }))
  expect(screen.getByRole('row', { name: /Pose/ })).toHaveTextContent('captures the pose')
})

it('lights a trigger whose button is pressed, and tells what is wrong with it', () => {
  const socket = taught()
  show(<TriggerTable arms={['left']} />)
  socket.tell(hand({ pressed: true }))
  const row = within(screen.getByRole('row', { name: /Joints/ }))
  expect(row.getByRole('img', { name: 'pressed' })).toBeVisible()
  socket.tell(hand({ fault: 'no topic has this name' }))
  expect(row.getByRole('img', { name: 'not pressed' })).toBeVisible()
  expect(row.getByText('no topic has this name')).toBeVisible()
})

it('keeps no trigger without a name, or with that of another one', async () => {
  const socket = taught()
  const user = show(<TriggerTable arms={['left']} />)
  socket.tell(hand({}))
  await user.click(screen.getByRole('button', { name: 'Add a trigger' }))
  await user.click(screen.getByRole('button', { name: 'Keep the trigger' }))
  await user.type(screen.getByLabelText('Name'), 'Joints')
  expect(screen.getByText('another trigger has this name')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Keep the trigger' }))
  expect(calls(SET)).toEqual([])
})

it('changes and removes a trigger, and says why that was refused', async () => {
  const socket = taught()
  const user = show(<TriggerTable arms={['left']} />)
  socket.tell(hand({}))
  await user.click(screen.getByRole('button', { name: 'Edit Joints' }))
  await user.selectOptions(screen.getByLabelText('Type'), 'hold')
  await user.click(screen.getByRole('button', { name: 'Keep the trigger' }))
  await waitFor(() => expect(calls(SET)).toEqual([{ triggers: [{ ...SAVE, trig_type: 'hold' }] }]))
  answers[SET] = () => new Refusal(409, { message: 'the file cannot be written' })
  await user.click(screen.getByRole('button', { name: 'Remove Joints' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('the file cannot be written')
  expect(calls(SET).at(-1)).toEqual({ triggers: [] })
})

it('shows the same as YAML, and a mistake in it with its line', async () => {
  const good = '- trig_name: "Joints"\n  trig_callback: "joint_save"\n'
  const write = 'teach/write_trigger_document'
  answers['teach/read_trigger_document'] = () => ({ file: 'triggers.yaml', text: good })
  answers[write] = () => new Refusal(422, { message: '`trig_callback` is none of these', where: 'triggers.yaml:2:18' })
  taught().tell(hand({}))
  const user = show(<TriggerTable arms={['left']} />)
  await user.click(screen.getByLabelText('YAML'))
  const text = await screen.findByLabelText('Triggers in triggers.yaml')
  expect(text).toHaveValue(good)
  expect(screen.getByRole('button', { name: 'Save the YAML' })).toHaveAttribute('title', 'Not possible: nothing is changed')
  fireEvent.change(text, { target: { value: good.replace('joint_save', 'joint') } })
  await user.click(screen.getByRole('button', { name: 'Save the YAML' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('Line 2, column 18: `trig_callback` is none of these')
  answers[write] = () => ({})
  fireEvent.change(text, { target: { value: `# By hand.\n${good}` } })
  await user.click(screen.getByRole('button', { name: 'Save the YAML' }))
  await waitFor(() => expect(screen.getByRole('status', { name: 'Saving the triggers' })).toHaveTextContent('Saved, and in force.'))
  expect(screen.queryByRole('alert')).toBeNull()
  expect(calls(write).at(-1)).toEqual({ text: `# By hand.\n${good}` })
})

it('says that there is no Helping Hand', () => {
  const socket = taught()
  show(<TriggerTable arms={['left']} />)
  socket.tell({ k: 'hand', status: null })
  expect(screen.getByText('No Helping Hand')).toBeVisible()
})

it('tells a viewer where the arm is, and why nothing can be moved', () => {
  const socket = taught('viewer')
  show(<JogPanel arm={LEFT} />)
  socket.tell(arm())
  const plus = screen.getByRole('button', { name: 'Z plus' })
  expect(plus).toHaveAttribute('aria-disabled', 'true')
  expect(plus).toHaveAttribute('title', 'Not possible: you may look only; log in with the operator token')
  expect(screen.getByRole('list', { name: 'Axes of the tool' })).toHaveTextContent('300.0 mm')
})

it('jogs as long as a button is held, and rests when it is let go', () => {
  const socket = taught()
  show(<JogPanel arm={LEFT} />)
  socket.tell(arm())
  const plus = screen.getByRole('button', { name: 'Z plus' })
  fireEvent.keyDown(plus, { key: 'Enter' })
  fireEvent.keyDown(plus, { key: 'Enter', repeat: true })
  expect(socket.sent).toEqual([
    { k: 'prepare', arm: 'left' },
    { k: 'jog', arm: 'left', space: 'tool', frame: 'world' },
    { k: 'go', velocity: [0, 0, expect.closeTo(0.05), 0, 0, 0] },
  ])
  fireEvent.keyUp(plus, { key: 'Enter' })
  expect(socket.sent.at(-1)).toEqual({ k: 'rest' })
})

it.each(['blur', 'pointerup', 'pagehide'])('rests when the page is left by %s', (leave) => {
  const socket = taught()
  show(<JogPanel arm={LEFT} />)
  socket.tell(arm())
  fireEvent.keyDown(screen.getByRole('button', { name: 'Z plus' }), { key: 'Enter' })
  fireEvent(window, new Event(leave))
  expect(socket.sent.at(-1)).toEqual({ k: 'rest' })
})

it.each([
  ['guiding', '', 'it floats: let it hold itself first'],
  ['moving', 'move_joints', 'it is moving: move_joints'],
  ['reflex', '', 'it has stopped by itself: recover it first'],
])('jogs no arm that is %s, and says why', (mode, activity, words) => {
  const socket = taught()
  show(<JogPanel arm={LEFT} />)
  socket.tell(arm({ mode, activity }))
  fireEvent.keyDown(screen.getByRole('button', { name: 'Z plus' }), { key: 'Enter' })
  expect(socket.sent).toEqual([{ k: 'prepare', arm: 'left' }])
  expect(screen.getByRole('status', { name: 'State of jogging' })).toHaveTextContent(words)
})

it('keeps tags that are written as tags are, and only where they have changed', async () => {
  const entry: EntryChanged = {
    kind: 'joints',
    name: 'aside',
    revision: 3,
    deleted: false,
    tags: ['station_1'],
    by: 'ana',
    reason: '',
    changed_unix_ms: 0,
  }
  answers['store/read_history'] = () => ({ changes: [] })
  server().on('POST /teach/tags', undefined).on('GET /teach/fits', {})
  taught()
  const user = show(<EntryDetails arm="left" entry={entry} />)
  const form = within(screen.getByRole('form', { name: 'Tags of aside' }))
  const keep = form.getByRole('button', { name: 'Save tags' })
  expect(keep).toHaveAttribute('title', 'Not possible: they are as they were')
  await user.clear(form.getByLabelText('Tags'))
  await user.type(form.getByLabelText('Tags'), 'Above')
  expect(form.getByText(/has only a–z/)).toBeVisible()
  await user.click(keep)
  expect(server().bodies('POST /teach/tags')).toEqual([])
  await user.clear(form.getByLabelText('Tags'))
  await user.type(form.getByLabelText('Tags'), 'tested, station_2')
  await user.click(keep)
  const body = { kind: 'joints', name: 'aside', tags: ['tested', 'station_2'], revision: 3 }
  await waitFor(() => expect(server().bodies('POST /teach/tags')).toEqual([body]))
})

/** A run that starts at a node has the data of the last run that entered it, as it is then changed. */
import { screen, waitFor } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { control, live, run, server, show } from '../../../testing/page'
import { askStartHere } from '../../api/startHere'
import type { BehaviorView, StartBody, StartData } from '../../api/types'
import { StartHereDialog } from './StartHereDialog'

const SHIFT: BehaviorView = {
  id: 'behaviors/shift.yaml',
  name: 'shift',
  description: '',
  parameters: [{ name: 'speed', schema: { type: 'number', title: 'Speed', default: 0.3 }, required: false }],
  findings: [],
  graph: null,
  view: {},
  success: [],
  fit: { cell: '', obstacle: '' },
}
const FOUND: StartData = { run: 'r7', seq: 41, started_unix_s: 1000, parameters: { speed: 0.2 }, userdata: { part: 'a' }, obstacle: '' }
const DATA = 'GET /runs/start-data'
const started = vi.fn()

function sent(): StartBody[] {
  return server().bodies('POST /runs') as StartBody[]
}

function Shown({ obstacle }: { readonly obstacle?: string }) {
  return <StartHereDialog behavior={SHIFT} obstacle={obstacle} onStarted={started} />
}

beforeEach(() => {
  started.mockReset()
  server().on('POST /runs', { run: 'r8' }).on(DATA, FOUND)
  live()
})

it('starts at the node with that data, as it was changed', async () => {
  askStartHere({ behavior: SHIFT.id, path: 'root/grasp', kind: 'from' })
  const user = show(<Shown />)
  const data = await screen.findByLabelText('Userdata')
  await waitFor(() => expect(data).toHaveValue('{\n "part": "a"\n}'))
  expect(screen.getByLabelText('Speed')).toHaveValue('0.2')
  expect(screen.getByText(/data that run r7 had/)).toBeVisible()
  await user.clear(data)
  await user.type(data, '{{"part": "b"}')
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() => expect(started).toHaveBeenCalled())
  expect(sent()).toMatchObject([{ begin: { run: 'r7', seq: 41, path: 'root/grasp' }, inputs: { part: 'b' }, parameters: { speed: 0.2 } }])
})

it('starts with the initial values where no run has entered the node', async () => {
  server().on(DATA, { ...FOUND, run: '', seq: null, parameters: {}, userdata: {} })
  askStartHere({ behavior: SHIFT.id, path: 'root/grasp', kind: 'from' })
  const user = show(<Shown />)
  expect(await screen.findByText(/No earlier run has entered this node/)).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Start' }))
  await waitFor(() => expect(sent()).toMatchObject([{ begin: { path: 'root/grasp' } }]))
})

it('says why a run cannot start there, and sends nothing', async () => {
  server().on(DATA, { ...FOUND, obstacle: 'the enclosing `foreach` was not active then (start at root/each)' })
  askStartHere({ behavior: SHIFT.id, path: 'root/grasp', kind: 'from' })
  show(<Shown />)
  expect(await screen.findByText(/the enclosing `foreach` was not active then/)).toBeVisible()
  expect(screen.getByRole('button', { name: 'Start' })).toBeDisabled()
})

it('starts at the beginning and pauses before the node that it runs to', async () => {
  askStartHere({ behavior: SHIFT.id, path: 'root/grasp', kind: 'to' })
  const user = show(<Shown />)
  await user.click(await screen.findByRole('button', { name: 'Start' }))
  await waitFor(() => expect(sent()).toMatchObject([{ until: 'root/grasp' }]))
  expect(sent()[0]?.begin).toBeUndefined()
})

it('lets the active run go on to the node', async () => {
  const point = { path: 'root/a', when: 'after' as const }
  server().on('POST /runs/r1/control/breakpoints', {}).on('POST /runs/r1/control/resume', {})
  live({ run: 'r1', runs: [run()], control: control({ paused: true, breakpoints: [point] }) })
  askStartHere({ behavior: SHIFT.id, path: 'root/grasp', kind: 'to' })
  const user = show(<Shown obstacle="This behavior is running" />)
  await user.click(await screen.findByRole('button', { name: 'Go on' }))
  await waitFor(() => expect(server().bodies('POST /runs/r1/control/resume')).toEqual([{}]))
  expect(server().bodies('POST /runs/r1/control/breakpoints')).toMatchObject([
    { breakpoints: [point, { path: 'root/grasp', when: 'before', once: true }] },
  ])
  expect(sent()).toEqual([])
})

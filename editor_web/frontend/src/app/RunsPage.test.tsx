/** The page of all runs: a card for each, commands to one of them, and two to be compared. */
import { act, screen, within } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { asks, control, graphNode, live, node, run, server, show, snapshot } from '../../testing/page'
import { FakeSocket, Refusal } from '../../testing/server'
import type { LiveSnapshot, RunView } from '../api/types'
import { RunsPage } from './RunsPage'

const ASKS = asks('root/left')
const NAP = run({ id: 'r1', behavior: 'behaviors/nap.yaml' })
const SHIFT = run({ id: 'r2', behavior: 'behaviors/shift.yaml', waits: 'asks' })
const NIGHT = run({ id: 'r3', behavior: 'behaviors/night.yaml', waits: 'paused' })
const OPEN = [NAP, SHIFT, NIGHT]
const opened = vi.fn()

const GRAPH = graphNode('root', { kind: 'machine', title: '', children: [graphNode('root/left'), graphNode('root/only')] })

/** The stream of one card, told how its run stands. */
function follow(of: RunView, told: Partial<LiveSnapshot>): FakeSocket {
  const wanted = (each: FakeSocket) => each.sent.some((sent) => JSON.stringify(sent) === JSON.stringify({ k: 'watch', run: of.id }))
  for (const each of FakeSocket.opened) if (each.readyState === FakeSocket.CONNECTING) each.accept()
  const socket = FakeSocket.opened.find(wanted)
  if (!socket) throw new Error(`nobody follows ${of.id}`)
  socket.tell({ k: 'hello', version: 1, epoch: 'e1', role: 'operator', server_time_s: 1000 })
  socket.tell(snapshot({ run: of.id, runs: OPEN, control: control(), ...told }))
  return socket
}

/** All three runs, as the server tells of them. */
async function shown(): Promise<ReturnType<typeof show>> {
  live({ runs: OPEN })
  const user = show(<RunsPage onOpen={opened} />)
  await screen.findAllByRole('article')
  follow(NAP, { nodes: { root: node(), 'root/only': node() } })
  follow(SHIFT, { control: control({ waiting: [ASKS], autonomy: 'low' }), nodes: { root: node(), 'root/left': node() } })
  follow(NIGHT, {
    control: control({
      paused: true,
      confirmed: true,
      waiting: [asks('root', { point: 'before', outcome: '', required: '', reasons: ['pause'] })],
    }),
  })
  return user
}

function card(name: string) {
  return within(screen.getByRole('article', { name: new RegExp(`^Run of ${name} since `) }))
}

beforeEach(() => {
  opened.mockReset()
  for (const name of ['nap', 'shift', 'night']) {
    server().on(`GET /behaviors/behaviors/${name}.yaml`, { id: `behaviors/${name}.yaml`, name, graph: GRAPH, findings: [], parameters: [] })
  }
  server().on('GET /interrupted', [])
})

it('tells on each card of its own run', async () => {
  await shown()
  server()
    .socket('/data')
    .tell({
      k: 'traffic',
      shape: 's',
      topics: {},
      goals: [],
      leases: [{ resource: 'left', run: 'r1', node: 'root/only', goal: '', held_s: 1 }],
    })
  expect(screen.getByText('3 are active, one asks')).toBeVisible()
  expect(card('nap').getByRole('status')).toHaveTextContent('Running')
  expect(card('nap').getByRole('list', { name: 'Active nodes' })).toHaveTextContent('only')
  expect(card('nap').getAllByRole('definition').at(-1)).toHaveTextContent('left')
  expect(await card('nap').findByRole('img', { name: '0 of 2 steps done, 1 active' })).toBeVisible()
  expect(card('shift').getByRole('status')).toHaveTextContent('Waiting for answer')
  expect(card('shift').getByRole('listitem', { name: 'Question of root/left' })).toHaveTextContent('which requires high')
  expect(card('shift').getAllByRole('definition').at(-1)).toHaveTextContent('no arm or device')
  expect(card('night').getByRole('status')).toHaveTextContent('Paused')
  expect(card('night').getByRole('list', { name: 'Nodes that wait' })).toHaveTextContent('root before its entry: paused')
})

it('sends a command on a card to that run only', async () => {
  for (const path of ['r1/control/pause', 'r2/control/answer', 'r3/stop']) server().on(`POST /runs/${path}`, {})
  const user = await shown()
  await user.click(card('nap').getByRole('button', { name: 'Pause' }))
  await user.click(card('shift').getByRole('button', { name: 'Agree: a' }))
  await user.click(card('night').getByRole('button', { name: 'Stop' }))
  const posts = server().asked.filter((each) => each.what.startsWith('POST'))
  expect(posts.map((each) => each.what)).toEqual(['POST /runs/r1/control/pause', 'POST /runs/r2/control/answer', 'POST /runs/r3/stop'])
})

it('names the run in a refusal', async () => {
  server().on('POST /runs/r2/control/answer', new Refusal(409, { message: 'this node asks nothing' }))
  const user = await shown()
  await user.click(card('shift').getByRole('button', { name: 'Agree: a' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('shift: Agree was refused: this node asks nothing')
})

it('lets a card take no command while its connection is lost', async () => {
  await shown()
  const socket = FakeSocket.opened.find((each) => each.sent.some((sent) => (sent as { run?: string }).run === 'r1'))
  socket?.cut()
  expect(card('nap').getByRole('button', { name: 'Pause' })).toHaveAttribute('title', 'Not possible: the server does not answer')
  expect(card('night').getByRole('button', { name: 'Resume' })).not.toHaveAttribute('aria-disabled')
  await act(() => Promise.resolve())
})

it('tells a viewer of every run, and why each command is not for them', async () => {
  live({ runs: OPEN }, 'viewer')
  show(<RunsPage onOpen={opened} />)
  await screen.findAllByRole('article')
  const socket = follow(SHIFT, {})
  socket.tell({ k: 'hello', version: 1, epoch: 'e1', role: 'viewer', server_time_s: 1000 })
  socket.tell(snapshot({ run: 'r2', runs: OPEN, control: control({ waiting: [ASKS, { ...ASKS, path: 'root/right' }] }) }))
  expect(card('shift').getByRole('status')).toHaveTextContent('Waiting for answer')
  for (const name of ['Pause', 'Take control', 'Stop']) {
    expect(card('shift').getByRole('button', { name })).toHaveAttribute(
      'title',
      'Not possible: you may look only; log in with the operator token',
    )
  }
  expect(card('shift').getAllByRole('button', { name: 'Agree: a' })[0]).toHaveAttribute('aria-disabled', 'true')
})

it('operates one run at a time', async () => {
  const user = await shown()
  const page = FakeSocket.opened[0]
  await user.click(card('nap').getByRole('button', { name: 'Take control' }))
  expect(card('nap').getByText(/^You operate this run/)).toBeVisible()
  await user.click(card('night').getByRole('button', { name: 'Take control' }))
  expect(card('night').getByText(/^You operate this run/)).toBeVisible()
  expect(card('nap').getByText(/^This run has no operator/)).toBeVisible()
  const operated = page?.sent.filter((sent) => (sent as { k: string }).k === 'operate')
  expect(operated).toEqual([
    { k: 'operate', run: 'r1' },
    { k: 'operate', run: 'r3' },
  ])
})

it('shows two runs side by side, once two are selected', async () => {
  const user = await shown()
  const aside = screen.getByRole('button', { name: 'Side by side' })
  await user.click(aside)
  expect(screen.getByRole('alert')).toHaveTextContent('tick Compare at two runs first')
  await user.click(screen.getByLabelText('Compare nap'))
  await user.click(screen.getByLabelText('Compare shift'))
  await user.click(screen.getByLabelText('Compare night'))
  await user.click(aside)
  expect(opened.mock.calls).toEqual([['/beside/r2/r3']])
})

it('opens a run by its name', async () => {
  const user = await shown()
  await user.click(card('night').getByRole('link', { name: 'night' }))
  expect(opened.mock.calls).toEqual([['/runs/r3']])
})

it('says what to do while no run is active', async () => {
  live({ runs: [run({ status: 'stopped', cause: 'enough' })] })
  show(<RunsPage onOpen={opened} />)
  expect(screen.getByText('None is active')).toBeVisible()
  expect(await screen.findByText(/Choose a behavior in the menu and start it/)).toBeVisible()
  expect(screen.getByRole('list', { name: 'Runs that ended last' })).toHaveTextContent('Stopped')
})

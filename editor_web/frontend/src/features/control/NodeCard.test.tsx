/** What can be done with a chosen node: breakpoints, locks, forced outcomes, and the list of all that holds a run. */
import { screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { control, graphNode, live, node, run, server, show, snapshot } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { loadSavedBreakpoints } from '../../api/breakpoints'
import type { Breakpoint, BreakpointsBody, ConditionCheck } from '../../api/types'
import { Holds } from './Holds'
import { NodeCard } from './NodeCard'
import { RefusalLine } from './RefusalLine'
import { useCommands } from './useCommands'

const SHIFT = 'behaviors/shift.yaml'
const RUN = run()
const REST = graphNode('root/rest', { title: 'flow.Wait', outcomes: ['done', 'late'] })
/** As it is written: what is as usual is left out. */
const POINT: Breakpoint = { path: 'root/rest' }

function Card({ isRunning = true }: { readonly isRunning?: boolean }) {
  const commands = useCommands(isRunning ? RUN : undefined, REST.path)
  return (
    <>
      <RefusalLine />
      <NodeCard node={REST} behavior="behaviors/shift.yaml" commands={commands} />
      <Holds commands={commands} onShow={() => undefined} />
    </>
  )
}

/** The server keeps breakpoints, and tells the page of those of the run. */
function keeping(points: readonly Breakpoint[] = []): void {
  server()
    .on(`GET /breakpoints/${SHIFT}`, { breakpoints: points })
    .on(`PUT /breakpoints/${SHIFT}`, ({ body }: { body: BreakpointsBody }) => body)
    .on(`POST /breakpoints/${SHIFT}/condition`, ({ body }: { body: Breakpoint }) => checked(body.if ?? ''))
}

/** What the engine says of a condition. */
function checked(condition: string): ConditionCheck {
  const isWrong = condition.startsWith('trys')
  return {
    problem: isWrong ? '`trys` is not defined before `rest`' : '',
    hint: isWrong ? 'did you mean tries?' : '',
    names: ['part', 'tries', 'trial'],
  }
}

beforeEach(async () => {
  keeping()
  await loadSavedBreakpoints(SHIFT)
})

it('keeps a breakpoint that is switched on, lists it, and takes it away', async () => {
  live()
  const user = show(<Card isRunning={false} />)
  expect(screen.getByText('Nothing holds this behavior')).toBeVisible()
  await user.click(await screen.findByLabelText('Pause before its entry'))
  expect(await screen.findByRole('button', { name: 'Remove the breakpoint before root/rest' })).toBeVisible()
  expect(server().bodies(`PUT /breakpoints/${SHIFT}`)).toMatchObject([{ breakpoints: [{ path: 'root/rest', when: 'before' }] }])
  await user.click(screen.getByRole('button', { name: 'Remove the breakpoint before root/rest' }))
  expect(await screen.findByText('Nothing holds this behavior')).toBeVisible()
  expect(server().bodies(`PUT /breakpoints/${SHIFT}`).at(-1)).toEqual({ breakpoints: [] })
})

it('keeps condition and count of a breakpoint when Enter is pressed, in the run and beside the file', async () => {
  keeping([POINT])
  server().on('POST /runs/r1/control/breakpoints', {})
  await loadSavedBreakpoints(SHIFT)
  live({ run: 'r1', runs: [RUN], control: control({ paused: true, breakpoints: [POINT] }) })
  const user = show(<Card />)
  await user.clear(screen.getByLabelText('From time'))
  await user.type(screen.getByLabelText('From time'), '3')
  await user.type(await screen.findByRole('combobox', { name: 'Only if' }), 'value == 1{Enter}')
  const wanted: Breakpoint = { path: 'root/rest', when: 'before', if: 'value == 1', hits: 3, outcomes: [], enabled: true, once: false }
  await waitFor(() => expect(server().bodies('POST /runs/r1/control/breakpoints').at(-1)).toEqual({ breakpoints: [wanted] }))
  expect(server().bodies(`PUT /breakpoints/${SHIFT}`).at(-1)).toEqual({ breakpoints: [wanted] })
})

it('says why a condition was refused', async () => {
  keeping([POINT])
  await loadSavedBreakpoints(SHIFT)
  server().on(`PUT /breakpoints/${SHIFT}`, new Refusal(422, { message: 'it does not compile', hint: 'such as tries > 1' }))
  live()
  const user = show(<Card isRunning={false} />)
  await user.type(await screen.findByRole('combobox', { name: 'Only if' }), 'value >{Enter}')
  expect(await screen.findByRole('alert')).toHaveTextContent('Breakpoint was refused: it does not compile – such as tries > 1')
})

it('tells a condition in the list of what holds', async () => {
  keeping([{ ...POINT, if: 'value == 1' }])
  await loadSavedBreakpoints(SHIFT)
  live()
  show(<Card isRunning={false} />)
  expect(screen.getByText('before, if value == 1')).toBeVisible()
})

it('offers the names that a condition can use, and says what the engine finds wrong with it', async () => {
  keeping([POINT])
  await loadSavedBreakpoints(SHIFT)
  live()
  const user = show(<Card isRunning={false} />)
  const field = await screen.findByRole('combobox', { name: 'Only if' })
  await user.clear(field)
  await user.type(field, 'trys')
  expect(await screen.findByText('`trys` is not defined before `rest`; did you mean tries?')).toBeVisible()
  await user.clear(field)
  await user.type(field, "part == 'cup' && tri")
  await user.click(await screen.findByRole('option', { name: 'tries' }))
  await user.type(field, ' > 1{Enter}')
  expect(field).toHaveValue("part == 'cup' && tries > 1")
  await waitFor(() => expect(screen.queryByText(/is not defined/)).toBeNull())
  expect(server().bodies(`PUT /breakpoints/${SHIFT}`).at(-1)).toMatchObject({ breakpoints: [{ if: "part == 'cup' && tries > 1" }] })
})

it('switches a breakpoint off without losing it, beside the node and in the list', async () => {
  keeping([POINT])
  await loadSavedBreakpoints(SHIFT)
  live()
  const user = show(<Card isRunning={false} />)
  await user.click(await screen.findByLabelText('Enabled'))
  expect(await screen.findByText(/off$/)).toBeVisible()
  expect(server().bodies(`PUT /breakpoints/${SHIFT}`).at(-1)).toMatchObject({ breakpoints: [{ path: 'root/rest', enabled: false }] })
  await user.click(screen.getByLabelText(/^Enabled: root\/rest/))
  await waitFor(() => expect(screen.getByLabelText('Enabled')).toBeChecked())
})

it('locks a node with a reason, tells it, and unlocks it', async () => {
  server().on('POST /runs/r1/control/lock', {}).on('POST /runs/r1/control/unlock', {})
  const socket = live({ run: 'r1', runs: [RUN], control: control() })
  const user = show(<Card />)
  await user.type(screen.getByLabelText('Reason of the lock'), 'the tray is being changed')
  await user.click(screen.getByRole('button', { name: 'Lock' }))
  expect(server().bodies('POST /runs/r1/control/lock')).toEqual([{ path: 'root/rest', reason: 'the tray is being changed' }])
  const lock_reasons = { 'root/rest': 'the tray is being changed' }
  socket.tell(snapshot({ run: 'r1', runs: [RUN], control: control({ locks: ['root/rest'] }), lock_reasons }))
  expect(screen.getByText('Locked: the tray is being changed')).toBeVisible()
  expect(screen.getByText('locked: the tray is being changed')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Unlock root/rest' }))
  await user.click(screen.getByRole('button', { name: 'Unlock' }))
  expect(server().bodies('POST /runs/r1/control/unlock')).toEqual([{ path: 'root/rest' }, { path: 'root/rest' }])
})

it('forces outcomes of an active node and runs it again, and says of one that is not active why not', async () => {
  server().on('POST /runs/r1/control/force', {}).on('POST /runs/r1/control/repeat', {})
  const socket = live({ run: 'r1', runs: [RUN], control: control() })
  const user = show(<Card />)
  const outcomes = within(screen.getByRole('group', { name: 'Force an outcome' }))
  expect(outcomes.getByRole('button', { name: 'late' })).toHaveAttribute('title', 'Not possible: this node is not active')
  socket.tell(snapshot({ run: 'r1', runs: [RUN], control: control(), nodes: { 'root/rest': node() } }))
  await user.click(outcomes.getByRole('button', { name: 'late' }))
  await user.click(screen.getByRole('button', { name: 'Run again' }))
  expect(server().bodies('POST /runs/r1/control/force')).toEqual([{ path: 'root/rest', outcome: 'late' }])
  expect(server().bodies('POST /runs/r1/control/repeat')).toEqual([{ path: 'root/rest' }])
})

it('lets a viewer set and remove no breakpoint', async () => {
  keeping([POINT])
  await loadSavedBreakpoints(SHIFT)
  live({}, 'viewer')
  const user = show(<Card isRunning={false} />)
  expect(await screen.findByLabelText('Pause before its entry')).toBeDisabled()
  await user.click(screen.getByRole('button', { name: 'Remove the breakpoint before root/rest' }))
  expect(screen.getByRole('alert')).toHaveTextContent('Breakpoint was refused: You may look only')
  expect(server().bodies(`PUT /breakpoints/${SHIFT}`)).toEqual([])
})

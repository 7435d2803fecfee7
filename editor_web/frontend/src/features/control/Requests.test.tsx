/** What a run asks its operator, how it is answered, and when a question is gone. */
import { screen } from '@testing-library/react'
import { expect, it } from 'vitest'
import { asks, control, graphNode, live, node, robot, run, server, show, snapshot } from '../../../testing/page'
import type { LiveSnapshot } from '../../api/types'
import { Requests } from './Requests'
import { useCommands } from './useCommands'

const RUN = run()
const ROOT = graphNode('root', { kind: 'concurrency', title: '', children: [graphNode('root/left'), graphNode('root/right')] })
const PLAN = { robot: 'left', duration_s: 3.25, length_m: 1.24, found_by: 'RRTConnect', planning_s: 0.12 }

function asking(...paths: string[]): Partial<LiveSnapshot> {
  const waiting = paths.map((path) => asks(path))
  return { run: 'r1', runs: [RUN], control: control({ waiting, autonomy: 'low' }) }
}

function Asked() {
  return <Requests root={ROOT} commands={useCommands(RUN, undefined)} onShow={() => undefined} />
}

it('shows each question with its ways', () => {
  live(asking('root/left', 'root/right'))
  show(<Asked />)
  const question = screen.getByRole('listitem', { name: 'Question of root/left' })
  expect(question).toHaveTextContent('root/left wants to end with a, which requires high')
  expect(screen.getAllByRole('listitem')).toHaveLength(2)
})

it.each([
  ['Agree: a', 'answer', { path: 'root/left' }],
  ['Force outcome: b', 'force', { path: 'root/left', outcome: 'b' }],
  ['Run again', 'repeat', { path: 'root/left' }],
])('answers with %s', async (name, command, body) => {
  server().on(`POST /runs/r1/control/${command}`, {})
  live(asking('root/left'))
  const user = show(<Asked />)
  await user.click(screen.getByRole('button', { name }))
  expect(server().bodies(`POST /runs/r1/control/${command}`)).toEqual([body])
})

it('takes a question away that has become void', () => {
  const socket = live(asking('root/left', 'root/right'))
  show(<Asked />)
  socket.tell(snapshot(asking('root/left')))
  expect(screen.getAllByRole('listitem')).toHaveLength(1)
  socket.tell(snapshot({ run: 'r1', runs: [RUN], control: control() }))
  expect(screen.queryByRole('region', { name: 'The run asks' })).toBeNull()
})

it('says what way an answer is about, and whether the 3D view shows it', () => {
  const told = { ...asking('root/left'), nodes: { 'root/left': node({ status: 'done', plan: PLAN }) } }
  const path = { state: 'proposed', reason: '', length_m: 1.24, since_s: 0 }
  const socket = live({ ...told, robots: { left: robot({ path }) } })
  show(<Asked />)
  const question = screen.getByRole('listitem', { name: 'Question of root/left' })
  expect(question).toHaveTextContent("left: 3.25 s for 1.24 m of the tool's path, found by RRTConnect in 0.12 s")
  expect(question).toHaveTextContent('shown in the 3D view')
  socket.tell(snapshot({ ...told, robots: { left: robot() } }))
  expect(question).toHaveTextContent('no longer in the 3D view')
})

it('lets a viewer read the question, and answer nothing', () => {
  live(asking('root/left'), 'viewer')
  show(<Asked />)
  expect(screen.getByRole('button', { name: 'Agree: a' })).toHaveAttribute(
    'title',
    'Not possible: you may look only; log in with the operator token',
  )
})

/** The wizard of waypoints: they are taken from the arm, put into another order, blended, deleted, and shown. */
import { screen, waitFor, within } from '@testing-library/react'
import { useEffect } from 'react'
import { expect, it, vi } from 'vitest'
import { armInfo, live, server, show } from '../../../testing/page'
import type { FakeSocket } from '../../../testing/server'
import { connectTeach } from '../../api/teaching'
import { WaypointWizard } from './WaypointWizard'

const set = vi.fn()
const closed = vi.fn()
const FIRST = { joints: [0.1, 0.2] }
const SECOND = { pose: { xyz: [0.4, 0, 0.2], xyzw: [1, 0, 0, 0] }, blend_m: 0.05 }
const ENTRIES = [
  { kind: 'pose', name: 'above' },
  { kind: 'joints', name: 'home' },
]

const jogWords = (arm: string) => `jog ${arm}`

function Wizard({ value }: { readonly value: unknown }) {
  useEffect(connectTeach, [])
  const asked = { kind: 'waypoints', title: 'waypoints of go', arm: 'left', value, entries: ENTRIES, onSet: set } as const
  return <WaypointWizard asked={asked} jog={jogWords} view={undefined} isNarrow={false} onClose={closed} />
}

/** The wizard, whose server has told of one arm and where its tool is. */
function told(value?: unknown) {
  set.mockReset()
  closed.mockReset()
  live()
  const user = show(<Wizard value={value} />)
  const socket = server().socket('/teach/live')
  socket.accept()
  socket.tell({ k: 'arms', arms: [armInfo()], can_push: false, frames: [] })
  at(socket, [0.5, 0.1, 0.3], [0.5, -0.25])
  return { user, socket }
}

function at(socket: FakeSocket, xyz: readonly number[], joints: readonly number[]): void {
  const tool_pose = [...xyz, 1, 0, 0, 0]
  socket.tell({ k: 'now', arms: { left: { mode: 'idle', activity: '', error: '', joints, tool_pose, tool: null } } })
}

async function used(user: ReturnType<typeof show>): Promise<unknown> {
  await user.click(screen.getByText('Use this value'))
  return set.mock.lastCall?.[0]
}

it('takes joints and poses of the arm and entries, one after the other, and marks them', async () => {
  const { user, socket } = told()
  expect(screen.getByText('Use this value').closest('button')).toHaveAttribute('aria-disabled', 'true')
  await user.click(screen.getByText('Add the present joints'))
  at(socket, [0.6, 0, 0.3], [1, 1])
  await user.click(screen.getByText('Add the present pose'))
  await user.selectOptions(screen.getByLabelText('Add an entry'), 'home (joints)')
  expect(
    within(screen.getByLabelText('Waypoints'))
      .getAllByTitle('Show it')
      .map((each) => each.textContent),
  ).toEqual(['0: joints 0.50, -0.25', '1: pose 0.600, 0.000, 0.300 m', '2: home'])
  await waitFor(() =>
    expect(socket.sent).toContainEqual(
      expect.objectContaining({
        k: 'mark',
        points: [
          [0.5, 0.1, 0.3],
          [0.6, 0, 0.3],
        ],
      }),
    ),
  )
  expect(socket.sent).toContainEqual(expect.objectContaining({ k: 'look', arm: 'left', kind: 'joints', name: 'home', value: null }))
  expect(await used(user)).toEqual([
    { joints: [0.5, -0.25] },
    { pose: { xyz: [0.6, 0, 0.3], xyzw: [1, 0, 0, 0] } },
    { joints: { entry: 'home' } },
  ])
  expect(closed).toHaveBeenCalled()
})

it('adds behind the waypoint that is chosen, whose arm is shown', async () => {
  const { user, socket } = told([FIRST, SECOND])
  await user.click(screen.getByText(/^0: joints/))
  await waitFor(() => expect(socket.sent).toContainEqual(expect.objectContaining({ k: 'look', kind: 'joints', value: FIRST })))
  await user.click(screen.getByText('Add the present joints'))
  expect(await used(user)).toEqual([FIRST, { joints: [0.5, -0.25] }, SECOND])
})

it('puts waypoints into another order, and deletes them', async () => {
  const { user } = told([FIRST, SECOND, { pose: { entry: 'above' } }])
  expect(screen.getByLabelText('Move waypoint 0 up')).toBeDisabled()
  expect(screen.getByLabelText('Move waypoint 2 down')).toBeDisabled()
  await user.click(screen.getByLabelText('Move waypoint 2 up'))
  await user.click(screen.getByLabelText('Move waypoint 0 down'))
  await user.click(screen.getByLabelText('Delete waypoint 2'))
  expect(await used(user)).toEqual([{ pose: { entry: 'above' } }, FIRST])
})

it('sets how near the tool passes each waypoint but the last, at which it stops', async () => {
  const { user } = told([FIRST, SECOND, FIRST])
  expect(screen.getByLabelText('Blend of waypoint 2')).toBeDisabled()
  await user.type(screen.getByLabelText('Blend of waypoint 0'), '0.1')
  await user.clear(screen.getByLabelText('Blend of waypoint 1'))
  expect(await used(user)).toEqual([{ ...FIRST, blend_m: 0.1 }, { pose: SECOND.pose }, FIRST])
})

it('refuses joints of another arm, and keeps expressions as they are', async () => {
  const { user } = told([{ joints: [1, 2, 3] }, '${last}'])
  expect(screen.getByText(/Waypoint 0 has not as many joints as the arm, 2/)).toBeInTheDocument()
  expect(screen.getByLabelText('Blend of waypoint 1')).toBeDisabled()
  await user.click(screen.getByLabelText('Delete waypoint 0'))
  expect(await used(user)).toEqual(['${last}'])
})

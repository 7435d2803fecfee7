/** The wizards: what is taken from the arm or typed becomes a plain value of the document. */
import { screen, waitFor, within } from '@testing-library/react'
import { useEffect } from 'react'
import { expect, it, vi } from 'vitest'
import { armInfo, live, server, show } from '../../../testing/page'
import type { FakeSocket } from '../../../testing/server'
import { connectTeach } from '../../api/teaching'
import type { PlainRequest, PoseRequest } from '../../api/valueWizard'
import { GridWizard } from './GridWizard'
import { JointWizard } from './JointWizard'
import { PoseWizard } from './PoseWizard'
import { RegionWizard } from './RegionWizard'

const set = vi.fn()
const closed = vi.fn()
const SHARED = { jog: (arm: string) => <p>jog {arm}</p>, view: undefined, isNarrow: false, onClose: closed }

function Wizard({ of }: { readonly of: PoseRequest | PlainRequest }) {
  useEffect(connectTeach, [])
  switch (of.kind) {
    case 'pose':
      return <PoseWizard {...SHARED} asked={of} />
    case 'joints':
      return <JointWizard {...SHARED} asked={of} />
    case 'region':
      return <RegionWizard {...SHARED} asked={of} />
    case 'grid':
      return <GridWizard {...SHARED} asked={of} />
  }
}

const REQUEST = { title: 'target of go', arm: 'left', value: undefined, onSet: set }
const POSE: PoseRequest = { ...REQUEST, kind: 'pose', form: 'xyzw', frames: ['world'], meant: (frame) => frame }

/** The wizard, whose server has told of one arm and where its tool is. */
function told(of: PoseRequest | PlainRequest) {
  set.mockReset()
  closed.mockReset()
  live()
  const user = show(<Wizard of={of} />)
  const socket = server().socket('/teach/live')
  socket.accept()
  socket.tell({ k: 'arms', arms: [armInfo()], can_push: false, frames: [] })
  at(socket, [0.5, 0.1, 0.3])
  return { user, socket }
}

function at(socket: FakeSocket, xyz: readonly number[], joints: readonly number[] = [0.5, -0.25]): void {
  const tool_pose = [...xyz, 1, 0, 0, 0]
  socket.tell({ k: 'now', arms: { left: { mode: 'idle', activity: '', error: '', joints, tool_pose, tool: null } } })
}

/** By their words: roles of all that is in a dialog are looked for slowly here. */
function button(words: string): HTMLElement {
  const found = screen.getByText(words).closest('button')
  if (!found) throw new Error(`${words} is no button`)
  return found
}

async function press(user: ReturnType<typeof show>, words: string): Promise<void> {
  await user.click(button(words))
}

/** Take the points of these rows, one after the other, with the tool at these places. */
async function take(user: ReturnType<typeof show>, socket: FakeSocket, points: readonly (readonly number[])[]): Promise<void> {
  for (const point of points) {
    at(socket, point)
    const [words] = screen.getAllByText('Take')
    if (!words) throw new Error('there is no point to take')
    await user.click(words)
  }
}

it('takes the present pose of the tool, in the world', async () => {
  const { user } = told(POSE)
  expect(button('Use this value')).toHaveAttribute('aria-disabled', 'true')
  await press(user, 'Take the present pose')
  await press(user, 'Use this value')
  expect(set).toHaveBeenCalledWith({ xyz: [0.5, 0.1, 0.3], xyzw: [1, 0, 0, 0] })
  expect(closed).toHaveBeenCalled()
})

it('gives a grasp as it is seen from the part that the state names', async () => {
  const { user } = told({
    ...POSE,
    frames: ['part', 'world'],
    value: { xyz: [0, 0, 0], frame: 'part' },
    meant: (name) => (name === 'part' ? 'plate' : name),
  })
  server()
    .socket('/data')
    .tell({ k: 'cell', poses: { plate: { xyz: [0.5, 0, 0.25], xyzw: [0, 0, 0, 1], frame: 'world' } }, cameras: {}, tools: {} })
  await press(user, 'Take the present pose')
  await press(user, 'Use this value')
  expect(set).toHaveBeenCalledWith({ xyz: [0, 0.1, 0.05], xyzw: [1, 0, 0, 0], frame: 'part' })
})

it('keeps a pose where it is when it is given in another frame', async () => {
  const { user } = told({ ...POSE, frames: ['plate'], value: { xyz: [0.5, 0.1, 0.3], xyzw: [1, 0, 0, 0] } })
  server()
    .socket('/data')
    .tell({ k: 'cell', poses: { plate: { xyz: [0.5, 0, 0.25], xyzw: [0, 0, 0, 1], frame: 'world' } }, cameras: {}, tools: {} })
  await user.selectOptions(screen.getByLabelText('Given in the frame'), 'plate')
  await press(user, 'Use this value')
  expect(set).toHaveBeenCalledWith({ xyz: [0, 0.1, 0.05], xyzw: [1, 0, 0, 0], frame: 'plate' })
})

it('takes nothing while it is not known where the frame is', () => {
  told({ ...POSE, frames: ['part'], value: { xyz: [0, 0, 0], frame: 'part' }, meant: () => '' })
  expect(button('Take the present pose')).toHaveAttribute('aria-disabled', 'true')
  expect(screen.getByText('where part is, is not known: choose another frame')).toBeInTheDocument()
})

it('makes a pose of three points, and says why some make none', async () => {
  const { user, socket } = told(POSE)
  await user.click(screen.getByLabelText('By three points'))
  await take(user, socket, [
    [0.4, 0, 0.1],
    [0.5, 0, 0.1],
    [0.6, 0.001, 0.1],
  ])
  expect(screen.getByText(/are on one line/)).toBeInTheDocument()
  await user.click(screen.getByRole('switch', { name: /looks into the plane/ }))
  const y = screen.getByLabelText('Point on y y')
  await user.clear(y)
  await user.type(y, '0.2')
  await press(user, 'Make the pose of the points')
  await press(user, 'Use this value')
  expect(set).toHaveBeenCalledWith({ xyz: [0.4, 0, 0.1], xyzw: [0, 0, 0, 1] })
})

it('writes the turn of an obstacle as roll, pitch and yaw', async () => {
  const { user } = told({ ...POSE, form: 'rpy', value: { xyz: [0, 0, 0], rpy: [0, 0, 0.5] } })
  await press(user, 'Use this value')
  expect(set).toHaveBeenCalledWith({ xyz: [0, 0, 0], rpy: [0, 0, 0.5] })
})

it('takes the joints of the arm, and refuses what is beyond a limit', async () => {
  const { user } = told({ ...REQUEST, kind: 'joints' })
  await press(user, 'Take the present joints')
  const second = screen.getByLabelText('j2 in radians')
  await user.clear(second)
  await user.type(second, '1.9')
  expect(screen.getByText('j2 is limited to -1.760 to 1.760 rad')).toBeInTheDocument()
  expect(button('Use this value')).toHaveAttribute('aria-disabled', 'true')
  await user.clear(second)
  await user.type(second, '1.5')
  await press(user, 'Use this value')
  expect(set).toHaveBeenCalledWith([0.5, 1.5])
})

it('shows the arm in the joints that are set, after a moment', async () => {
  const { user, socket } = told({ ...REQUEST, kind: 'joints' })
  await press(user, 'Take the present joints')
  await waitFor(() =>
    expect(socket.sent).toContainEqual(expect.objectContaining({ k: 'look', arm: 'left', value: { joints: [0.5, -0.25] } })),
  )
})

it('makes a region of two corners that the tool touches', async () => {
  const { user, socket } = told({ ...REQUEST, kind: 'region' })
  await take(user, socket, [
    [0.6, 0.2, 0.3],
    [0.4, -0.2, 0.1],
  ])
  await user.click(screen.getByLabelText('Only between two heights'))
  await press(user, 'Use this value')
  expect(set).toHaveBeenCalledWith({ center_m: [0.5, 0], size_m: [0.2, 0.4], height_m: [0.1, 0.3] })
  await waitFor(() =>
    expect(socket.sent).toContainEqual(
      expect.objectContaining({
        k: 'mark',
        box: [
          [0.4, -0.2, 0.1],
          [0.6, 0.2, 0.3],
        ],
      }),
    ),
  )
})

it('keeps the region of the document until another is taken, and refuses one without an area', async () => {
  const { user, socket } = told({ ...REQUEST, kind: 'region', value: { center_m: [1, 2], size_m: [0.2, 0.4] } })
  await press(user, 'Use this value')
  expect(set).toHaveBeenCalledWith({ center_m: [1, 2], size_m: [0.2, 0.4] })
  await take(user, socket, [
    [0.6, 0.2, 0.3],
    [0.6, -0.2, 0.1],
  ])
  expect(screen.getByText(/the region has no area/)).toBeInTheDocument()
})

it('lists the places of a grid, with the turn of the tool', async () => {
  const { user, socket } = told({ ...REQUEST, kind: 'grid' })
  await take(user, socket, [
    [0.4, 0, 0.1],
    [0.6, 0, 0.1],
    [0.4, 0.1, 0.1],
  ])
  expect(within(screen.getByLabelText('Places')).getAllByText(/m, /)).toHaveLength(6)
  await press(user, 'Take the present turn of the tool')
  await press(user, 'Use this value')
  const poses = set.mock.calls[0]?.[0] as { xyz: number[]; xyzw: number[] }[]
  expect(poses.map((pose) => pose.xyz)).toEqual([
    [0.4, 0, 0.1],
    [0.5, 0, 0.1],
    [0.6, 0, 0.1],
    [0.4, 0.1, 0.1],
    [0.5, 0.1, 0.1],
    [0.6, 0.1, 0.1],
  ])
  expect(poses[0]?.xyzw).toEqual([1, 0, 0, 0])
})

it('offers the panel that jogs the arm of the value', async () => {
  const { user } = told({ ...REQUEST, kind: 'joints' })
  await press(user, 'Jog')
  expect(await screen.findByText('jog left')).toBeInTheDocument()
})

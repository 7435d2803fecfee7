/** A named entry as an arm would be there: which arm, what is known of it, and why it cannot be shown. */
import { screen, waitFor } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { armInfo, live, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { EntryChanged } from '../../api/types'
import type { Previewed } from '../../api/preview'
import { EntryPreview } from './EntryPreview'

const ARM = armInfo({
  joint_names: ['j1'],
  lower_rad: [-1],
  upper_rad: [1],
  velocity_rad_s: [1],
  acceleration_rad_s2: [10],
  effort_nm: [80],
  jerk_rad_s3: [100],
})
const ROW: EntryChanged = {
  kind: 'joints',
  name: 'above',
  revision: 3,
  deleted: false,
  tags: ['station_1'],
  by: 'ana',
  reason: 'more room',
  changed_unix_ms: 0,
}
const SHOWN: Previewed = { by: 'field', kind: 'joints', name: 'above', arm: 'left' }
const closed = vi.fn()

function Shown({ of = SHOWN, isSheet = false }: { readonly of?: Previewed; readonly isSheet?: boolean }) {
  return <EntryPreview shown={of} view={null} tools={null} isSheet={isSheet} onClose={closed} />
}

/** The preview, whose server has told which arms there are. */
function told(of: Previewed, ...arms: string[]) {
  live()
  const user = show(<Shown of={of} />)
  const socket = server().socket('/teach/live')
  socket.accept()
  socket.tell({ k: 'arms', arms: arms.map((name) => ({ ...ARM, name })), can_push: false, frames: [] })
  return { user, socket }
}

beforeEach(() => {
  closed.mockReset()
  server()
    .on('GET /teach/entries', { entries: [ROW], total: 1 })
    .on('GET /teach/fits', {
      demonstration: { times_s: [0], joint_names: ['j1'], joints: [[0.5]], poses: [], remark: '' },
      primitive: null,
      joint_fit: null,
      cart_fit: null,
    })
})

it('shows the arm of the state at the entry until it is closed, with what is known of the entry', async () => {
  const { user, socket } = told(SHOWN, 'left', 'right')
  expect(await screen.findByText('left is shown at above')).toBeInTheDocument()
  expect(socket.sent.at(-1)).toEqual({ k: 'look', arm: 'left', revision: 0, kind: 'joints', name: 'above', capture: 0, place: 0 })
  expect(screen.getByText(/28\.6 °/)).toBeVisible()
  expect(screen.getByText('by ana, more room')).toBeVisible()
  expect(screen.getByText('station_1')).toBeVisible()
  await user.selectOptions(screen.getByLabelText('Arm that is shown'), 'right')
  expect(socket.sent.at(-1)).toMatchObject({ k: 'look', arm: 'right', name: 'above' })
  await user.click(screen.getByRole('button', { name: 'Close the preview' }))
  expect(closed).toHaveBeenCalledOnce()
})

it.each([
  [{ ...SHOWN, arm: 'middle' }, ['left'], 'This cell has no arm middle; choose another one.'],
  [{ ...SHOWN, name: '' }, ['left'], 'No entry is selected.'],
  [SHOWN, [], 'This cell has no arm that could be shown.'],
])('says why there is nothing to see', async (of, arms, words) => {
  told(of, ...arms)
  await waitFor(() => expect(screen.getByRole('status')).toHaveTextContent(words))
})

it('says in the words of the server what an arm cannot do', async () => {
  server().on('GET /teach/fits', new Refusal(422, { message: 'the entry has 6 joints, left has 7' }))
  told(SHOWN, 'left')
  await waitFor(() => expect(screen.getByRole('status')).toHaveTextContent('the entry has 6 joints, left has 7'))
})

it('says that the server does not answer, and shows nothing meanwhile', async () => {
  const { socket } = told(SHOWN, 'left')
  await screen.findByText('left is shown at above')
  socket.cut()
  expect(screen.getByRole('status')).toHaveTextContent('The server does not answer')
})

it('closes with Escape', async () => {
  const { user } = told(SHOWN, 'left')
  screen.getByRole('button', { name: 'Close the preview' }).focus()
  await user.keyboard('{Escape}')
  expect(closed).toHaveBeenCalledOnce()
})

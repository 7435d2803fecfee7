/** The behaviors of the project, and making a new one. */
import { screen, waitFor, within } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { live, run, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { BehaviorList } from './BehaviorList'

const SHIFT = {
  id: 'behaviors/day/shift.yaml',
  name: 'shift',
  description: 'moves cups',
  errors: 0,
  warnings: 2,
  fit: { cell: '', obstacle: '' },
}
const NAP = { id: 'behaviors/nap.yaml', name: 'nap', description: '', errors: 1, warnings: 0, fit: { cell: 'home', obstacle: '' } }
const opened = vi.fn()
const made = vi.fn()

const BOTH = [SHIFT, NAP]

function List({ mayMake = true, behaviors = BOTH }: { readonly mayMake?: boolean; readonly behaviors?: readonly (typeof NAP)[] }) {
  return (
    <BehaviorList
      behaviors={behaviors}
      current={NAP.id}
      href={(id) => `/behaviors/${id}`}
      onOpen={opened}
      onMade={mayMake ? made : undefined}
    />
  )
}

it('lists them with folder, problems, and whether they run', async () => {
  opened.mockReset()
  live({ runs: [run({ behavior: SHIFT.id })] })
  const user = show(<List />)
  const [shift, nap] = screen.getAllByRole('link')
  expect(shift).toHaveTextContent('day')
  expect(shift).toHaveTextContent('2 warnings')
  expect(within(shift ?? document.body).getByRole('img', { name: 'active' })).toBeVisible()
  expect(nap).toHaveTextContent('1 error')
  expect(nap).toHaveAttribute('aria-current', 'page')
  await user.click(screen.getByRole('link', { name: /shift/ }))
  expect(opened.mock.calls).toEqual([[SHIFT.id]])
})

it('groups those of other cells apart, and says why they cannot be started', async () => {
  live()
  const obstacle = 'it is written for the cell lathe, and home is connected: the robot arm is ur10 there and irb4600 here'
  const turn = { ...NAP, id: 'behaviors/turn.yaml', name: 'turn', fit: { cell: 'lathe', obstacle } }
  const user = show(<List behaviors={[turn, SHIFT, NAP]} />)
  const group = screen.getByText('Of other cells (1)')
  expect(screen.getAllByRole('link')[0]).toHaveTextContent('shift')
  await user.click(group)
  const link = screen.getByRole('link', { name: /turn/ })
  expect(link).toHaveTextContent('cell lathe')
  expect(link).toHaveAttribute('title', obstacle)
})

it('finds them by what they are for', async () => {
  live()
  const user = show(<List />)
  await user.type(screen.getByLabelText('Find a behavior'), 'Cups')
  expect(screen.getAllByRole('link')).toHaveLength(1)
  await user.type(screen.getByLabelText('Find a behavior'), '!')
  expect(screen.getByText('None matches')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Clear' }))
  expect(screen.getAllByRole('link')).toHaveLength(2)
})

it('makes a new one, whose file is named before', async () => {
  made.mockReset()
  server().on('GET /deleted_documents', []).on('POST /documents', { id: 'behaviors/night/my_run.yaml' })
  live()
  const user = show(<List />)
  await user.click(screen.getByRole('button', { name: 'New' }))
  const dialog = within(screen.getByRole('dialog', { name: 'New behavior' }))
  await user.click(dialog.getByRole('button', { name: 'Create' }))
  expect(dialog.getByRole('alert')).toHaveTextContent('It needs a name')
  await user.type(dialog.getByLabelText('Name'), 'my run')
  await user.type(dialog.getByLabelText('Folder, if any'), '/night/')
  await user.selectOptions(dialog.getByLabelText('Begins as'), 'sequence')
  expect(dialog.getByText('behaviors/night/my_run.yaml')).toBeVisible()
  await user.click(dialog.getByRole('button', { name: 'Create' }))
  await waitFor(() => expect(made.mock.calls).toEqual([['behaviors/night/my_run.yaml']]))
  expect(server().bodies('POST /documents')).toEqual([{ id: 'behaviors/night/my_run.yaml', name: 'my run', template: 'sequence' }])
  expect(screen.queryByRole('dialog')).toBeNull()
})

it('says why a new one was refused, and brings back one that was deleted', async () => {
  made.mockReset()
  server()
    .on('GET /deleted_documents', [{ id: 'behaviors/gone.yaml', saved_at: 1000 }])
    .on('POST /documents', new Refusal(409, { message: 'there is such a file already' }))
    .on('POST /documents/behaviors/gone.yaml/restore', { id: 'behaviors/gone.yaml' })
  live()
  const user = show(<List />)
  await user.click(screen.getByRole('button', { name: 'New' }))
  await user.type(screen.getByLabelText('Name'), 'nap{Enter}')
  expect(await screen.findByRole('alert')).toHaveTextContent('there is such a file already')
  await user.click(await screen.findByText('Deleted behaviors'))
  await user.click(screen.getByRole('button', { name: 'Restore' }))
  await waitFor(() => expect(made.mock.calls).toEqual([['behaviors/gone.yaml']]))
})

it('offers a viewer no new one, and says what to do in an empty project', () => {
  live({}, 'viewer')
  show(<List mayMake={false} behaviors={[]} />)
  expect(screen.queryByRole('button', { name: 'New' })).toBeNull()
  expect(screen.getByText('Put a YAML document below behaviors/.')).toBeVisible()
})

it('says nothing of an empty project before the server has told the behaviors', () => {
  live()
  show(<BehaviorList behaviors={undefined} current={undefined} href={() => ''} onOpen={opened} onMade={undefined} />)
  expect(screen.getByRole('textbox', { name: 'Find a behavior' })).toBeVisible()
  expect(screen.queryByText('No behaviors')).toBeNull()
})

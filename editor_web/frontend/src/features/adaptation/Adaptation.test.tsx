/** A behavior of another cell is adapted: names are selected, what stays open is shown before anything is written. */
import { screen, waitFor } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { live, server, show } from '../../../testing/page'
import type { AdaptationBody, MappedName } from '../../api/types'
import { AdaptHere } from './AdaptHere'

const PLAN = 'POST /documents/behaviors/palletise.yaml/adaptation'
const WRITE = 'POST /documents/behaviors/palletise.yaml/adapt'
const ARM: MappedName = {
  kind: 'robot',
  name: 'left',
  detail: 'panda, 7 joints, gripper',
  target: 'arm',
  reason: 'the most like it',
  candidates: [{ name: 'arm', detail: 'ur10, 6 joints, gripper' }],
  paths: ['root/go'],
}
const HOME: MappedName = {
  kind: 'joints',
  name: 'left_home',
  detail: '7 joints',
  target: '',
  reason: 'no joints entry has this name',
  candidates: [
    { name: 'home', detail: '6 joints' },
    { name: 'wait', detail: '6 joints' },
  ],
  paths: ['root/go', 'root/back'],
}
const MISSING = {
  severity: 'warning',
  code: 'missing-entry',
  message: 'there is no joints entry `left_home`',
  path: 'root/go',
  line: 9,
  column: 3,
  hint: '',
} as const
const MADE: AdaptationBody = {
  id: 'behaviors/palletise_ur10.yaml',
  name: 'palletise_ur10',
  plan: { own_cell: 'dual_panda', cell: 'ur10', names: [ARM, HOME], undecided: [], findings: [MISSING] },
  copies: ['behaviors/pick_ur10.yaml'],
}
const made = vi.fn()

function Shown({ mayEdit = true }: { readonly mayEdit?: boolean }) {
  return <AdaptHere behavior="behaviors/palletise.yaml" obstacle="the cell ur10 has no robot `left`" mayEdit={mayEdit} onMade={made} />
}

beforeEach(() => {
  made.mockReset()
  live()
  server().on(PLAN, MADE).on(WRITE, { id: MADE.id })
})

it('shows what each name becomes, and what stays open before anything is written', async () => {
  const user = show(<Shown />)
  await user.click(screen.getByRole('button', { name: 'Adapt…' }))
  expect(await screen.findByRole('combobox', { name: 'robot left becomes' })).toHaveValue('arm (ur10, 6 joints, gripper)')
  expect(screen.getByRole('combobox', { name: 'joints left_home becomes' })).toHaveValue('')
  expect(screen.getByText('Stays open: 1 warning')).toBeVisible()
  expect(screen.getByRole('list', { name: 'Stays open' })).toHaveTextContent('there is no joints entry left_home')
  expect(screen.getByText(/copies of them are made: behaviors\/pick_ur10.yaml/)).toBeVisible()
  expect(server().bodies(WRITE)).toEqual([])
})

it('asks for the plan anew with what is selected, and writes that', async () => {
  const user = show(<Shown />)
  await user.click(screen.getByRole('button', { name: 'Adapt…' }))
  server().on(PLAN, { ...MADE, plan: { ...MADE.plan, names: [ARM, { ...HOME, target: 'wait', reason: '' }], findings: [] } })
  await user.click(await screen.findByRole('combobox', { name: 'joints left_home becomes' }))
  await user.click(await screen.findByRole('option', { name: 'wait (6 joints)' }))
  expect(await screen.findByText('The check finds nothing in the adapted behavior.')).toBeVisible()
  expect(server().bodies(PLAN).at(-1)).toEqual({ names: { 'joints:left_home': 'wait' } })
  await user.clear(screen.getByRole('textbox', { name: 'Name' }))
  await user.type(screen.getByRole('textbox', { name: 'Name' }), 'stack')
  await user.click(screen.getByRole('button', { name: 'Create and open' }))
  await waitFor(() => expect(made.mock.calls).toEqual([[MADE.id]]))
  expect(server().bodies(WRITE)).toEqual([{ id: MADE.id, name: 'stack', names: { 'joints:left_home': 'wait' } }])
})

it('says to a viewer why it cannot be started, without the way to a copy', () => {
  show(<Shown mayEdit={false} />)
  expect(screen.getByText(/It cannot be started here: the cell ur10 has no robot/)).toBeVisible()
  expect(screen.queryByRole('button', { name: 'Adapt…' })).toBeNull()
})

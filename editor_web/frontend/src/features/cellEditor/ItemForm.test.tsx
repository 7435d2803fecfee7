/** The form of an item: what is changed is applied as edits, the name with it, and nothing that cannot be. */
import { act, fireEvent, screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { server, show } from '../../../testing/page'
import type { CellDraft, DraftItem } from '../../api/types'
import { useLive } from '../../api/live'
import { useWizard } from '../../api/valueWizard'
import { surroundingsOf } from '../../document/cellEditing'
import { AddMenu } from './AddMenu'
import { ItemForm } from './ItemForm'
import { openCellDocument } from './session'
import { cellEditor, draftOf, setCellEditor } from './store'

const ID = 'behaviors/cells/bench.yaml'
const EDITS = `POST /cell_documents/${ID}/edits`
const TABLE: DraftItem = {
  section: 'fixtures',
  name: 'table',
  line: 3,
  end_line: 3,
  value: { shape: 'box', size_m: [1, 0.8, 0.7], at: { xyz: [0.6, 0, 0.35] } },
}
const MODELS = { folders: ['bin'], robots: ['panda', 'ur10'], tools: ['panda_hand'] }
const DRAFT: CellDraft = {
  text: 'a',
  hash: 'h',
  kind: 'cell',
  items: [TABLE],
  findings: [
    {
      severity: 'error',
      code: 'invalid-document',
      message: '`table` floats',
      path: 'fixtures/table',
      line: 3,
      column: 1,
      hint: 'put it down',
    },
  ],
  frames: {},
  parts: {},
  positions: {},
}

beforeEach(async () => {
  server()
    .on(`GET /cell_documents/${ID}`, { id: ID, saved_at: 1, draft: DRAFT })
    .on('GET /cell/naming_behaviors', [{ id: 'behaviors/move.yaml', name: 'move the plate', paths: ['root/a', 'root/b'] }])
    .on(EDITS, { draft: { ...DRAFT, text: 'b' }, refused: null })
  await openCellDocument(ID)
})

function form(onSelect = vi.fn()) {
  const user = show(<ItemForm item={TABLE} surroundings={surroundingsOf(DRAFT, MODELS)} onSelect={onSelect} />)
  const field = (label: string) => screen.getByLabelText(label)
  const write = async (label: string, text: string) => {
    await user.clear(field(label))
    await user.type(field(label), text)
  }
  return { user, field, write, onSelect, apply: screen.getByRole('button', { name: 'Apply' }) }
}

it('applies what was changed, and only that', async () => {
  const { user, write, apply, onSelect } = form()
  expect(apply).toBeDisabled()
  await write('Position z', '0.40')
  await write('Roll, pitch, yaw y', '90')
  await user.click(apply)
  await waitFor(() => expect(server().bodies(EDITS)).toHaveLength(1))
  expect(server().bodies(EDITS)[0]).toEqual({
    text: 'a',
    edits: [
      { edit: 'set_field', section: 'fixtures', name: 'table', field: ['at', 'xyz'], value: [0.6, 0, 0.4] },
      { edit: 'set_field', section: 'fixtures', name: 'table', field: ['at', 'rpy'], value: [0, 0, 1.570796] },
    ],
  })
  expect(onSelect).not.toHaveBeenCalled()
})

it('renames, says what does not follow, and selects the item by its new name', async () => {
  const { user, write, onSelect } = form()
  await write('Name', 'bench')
  expect(await screen.findByText(/neither do these behaviors: move the plate \(2\)/)).toBeVisible()
  await user.keyboard('{Enter}')
  await waitFor(() => expect(onSelect).toHaveBeenCalledExactlyOnceWith('fixtures/bench'))
  expect(server().bodies(EDITS)[0]).toMatchObject({ edits: [{ edit: 'rename_item', new_name: 'bench' }] })
})

it('goes back to the document, and says what cannot be', async () => {
  const { user, field, write, apply } = form()
  await write('Name', 'Bench')
  expect(screen.getAllByText('Lower-case letters, digits and _')).toHaveLength(2)
  expect(apply).toBeDisabled()
  await user.click(screen.getByRole('button', { name: 'Reset' }))
  expect(field('Name')).toHaveValue('table')
  await write('Size x', '0')
  expect(screen.getByText('Size is above 0')).toBeVisible()
  expect(apply).toBeDisabled()
})

it('shows the findings of the item, and has the lengths of its shape', async () => {
  const { user, field } = form()
  expect(screen.getByRole('alert')).toHaveTextContent('`table` floats – put it down')
  await user.selectOptions(field('Shape'), 'cylinder')
  expect(field('Size diameter')).toHaveValue('1')
  expect(field('Size length')).toHaveValue('0.8')
  expect(screen.queryByLabelText('Size x')).toBeNull()
})

it('writes a switch only where it is not as usual', async () => {
  const module: DraftItem = { ...TABLE, section: 'modules', name: 'bin', value: { module: 'bin', connector: 'dock' } }
  const user = show(<ItemForm item={module} surroundings={surroundingsOf(DRAFT, MODELS)} onSelect={vi.fn()} />)
  const plugged = screen.getByRole('switch', { name: 'Plugged when the cell is opened' })
  expect(plugged).toBeChecked()
  await user.click(plugged)
  await user.click(screen.getByRole('button', { name: 'Apply' }))
  await waitFor(() => expect(server().bodies(EDITS)).toHaveLength(1))
  expect(server().bodies(EDITS)[0]).toMatchObject({ edits: [{ name: 'bin', field: ['plugged'], value: false }] })
  await user.click(plugged)
  expect(screen.getByRole('button', { name: 'Apply' })).toBeDisabled()
})

it('deletes it, where nothing else names it', async () => {
  const { user, onSelect } = form()
  server().on(EDITS, { draft: DRAFT, refused: { message: 'named by `slot`', hint: 'first', index: 0, losses: [] } })
  await user.click(screen.getByRole('button', { name: 'Delete: table' }))
  await waitFor(() => expect(cellEditor().notice?.message).toBe('named by `slot`'))
  expect(onSelect).not.toHaveBeenCalled()
})

it('adds an item by a free name and selects it; a module needs a connector', async () => {
  const onSelect = vi.fn()
  const user = show(<AddMenu surroundings={surroundingsOf(DRAFT, MODELS)} taken={['cylinder_1']} onSelect={onSelect} />)
  await user.click(screen.getByRole('button', { name: 'Add' }))
  const menu = await screen.findByRole('menu', { name: 'Add' })
  expect(within(menu).getByRole('menuitem', { name: 'Module' })).toBeDisabled()
  await user.click(within(menu).getByRole('menuitem', { name: 'Cylinder' }))
  await waitFor(() => expect(onSelect).toHaveBeenCalledExactlyOnceWith('fixtures/cylinder_2'))
  expect(draftOf(cellEditor()).text).toBe('b')
})

const CLAMP: DraftItem = {
  ...TABLE,
  section: 'devices',
  name: 'clamp',
  value: {
    axes: { main: { joint: 'slide', body: 'table', along: [1, 0, 0], stroke_m: 0.05, force_n: 40, speed_m_s: 0.1, output: 'valve' } },
    positions: { closed: { steps: [{ set: { valve: true } }], time: '2 s' } },
  },
}

it('changes a device by its groups: a number, a step, a sensor that it gets, and a name', async () => {
  const user = show(<ItemForm item={CLAMP} surroundings={surroundingsOf(DRAFT, MODELS)} onSelect={vi.fn()} />)
  const axis = within(screen.getByLabelText('Axis main'))
  await user.clear(axis.getByLabelText('Force at rest F'))
  await user.type(axis.getByLabelText('Force at rest F'), '55')
  await user.clear(axis.getByLabelText('Name of Axis main'))
  await user.type(axis.getByLabelText('Name of Axis main'), 'jaw')
  const position = within(screen.getByLabelText('Position closed'))
  await user.click(position.getByText('Step'))
  await user.selectOptions(position.getByLabelText('Outputs of step 1 valve'), 'off')
  await user.click(screen.getByText('Axis, sensor, position'))
  await user.click(await screen.findByText('Sensor at an axis'))
  fireEvent.submit(screen.getByLabelText('Change clamp'))
  await waitFor(() => expect(server().bodies(EDITS)).toHaveLength(1))
  const set = { edit: 'set_field', section: 'devices', name: 'clamp' }
  expect(server().bodies(EDITS)[0]).toMatchObject({
    edits: [
      { ...set, field: ['axes', 'main', 'force_n'], value: 55 },
      { ...set, field: ['positions', 'closed', 'steps'], value: [{ set: { valve: false } }, { pause: '500 ms' }] },
      { ...set, field: ['sensors'], value: { sensor_1: { axis: 'main', at_most: 0.002 } } },
      { edit: 'rename_field', field: ['axes', 'main'], new_name: 'jaw' },
    ],
  })
})

it('writes a limit of a bond that has none only when it is given', async () => {
  const bond: DraftItem = { ...TABLE, section: 'bonds', name: 'glue', value: { kind: 'glue', part: 'lid', to: 'table', force_n: 8 } }
  const user = show(<ItemForm item={bond} surroundings={surroundingsOf(DRAFT, MODELS)} onSelect={vi.fn()} />)
  expect(screen.getByLabelText('Breaks at (N)')).toHaveValue('8')
  expect(screen.getByLabelText('Breaks at a torque (Nm)')).toHaveValue('')
  await user.type(screen.getByLabelText('Breaks at a torque (Nm)'), '0.5')
  await user.clear(screen.getByLabelText('Breaks at (N)'))
  await user.click(screen.getByRole('button', { name: 'Apply' }))
  await waitFor(() => expect(server().bodies(EDITS)).toHaveLength(1))
  expect(server().bodies(EDITS)[0]).toMatchObject({
    edits: [
      { field: ['force_n'], value: null },
      { field: ['torque_nm'], value: 0.5 },
    ],
  })
})

it('says what an item touches at rest, and hinders nothing', async () => {
  const { write, apply } = form()
  const touching = { severity: 'warning', code: 'collision-at-rest', path: 'fixtures/table', line: 3, column: 1, hint: 'move one' }
  act(() => setCellEditor({ rest: [{ ...touching, message: '`left/hand` and `table` overlap by 3.0 mm' }] }))
  expect(screen.getByText(/overlap by 3.0 mm/)).toBeVisible()
  await write('Position z', '0.40')
  expect(apply).toBeEnabled()
})

it('is taught with an arm where the cell has one; the pose is seen from what it stands in', async () => {
  const at = (x: number) => ({ xyz: [x, 0, 0] as const, xyzw: [0, 0, 0, 1] as const, frame: 'world' })
  const standing: CellDraft = { ...DRAFT, frames: { world: at(0), table: at(1) } }
  server().on(`GET /cell_documents/${ID}`, { id: ID, saved_at: 1, draft: standing })
  await openCellDocument(ID)
  const slot: DraftItem = { ...TABLE, section: 'frames', name: 'slot', value: { parent: 'table' } }
  const user = show(<ItemForm item={slot} surroundings={surroundingsOf(standing, MODELS)} onSelect={vi.fn()} />)
  expect(screen.getByRole('button', { name: 'Teach with an arm' })).toHaveAttribute('aria-disabled', 'true')
  act(() => useLive.setState({ robots: { left: {} as never } }))
  await user.click(screen.getByRole('button', { name: 'Teach with an arm' }))
  const asked = useWizard.getState().asked
  expect(asked).toMatchObject({ kind: 'pose', title: 'slot', isFrame: true, frames: [], value: { xyz: [1, 0, 0] } })
  act(() => asked?.onSet({ xyz: [1.25, 0.5, 0], xyzw: [0, 0, 0, 1] }))
  expect(screen.getByLabelText('Position x')).toHaveValue('0.25')
  expect(screen.getByLabelText('Position y')).toHaveValue('0.5')
})

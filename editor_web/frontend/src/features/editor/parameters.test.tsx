/** The fields of a state: what they offer, what nothing has, values with fields, and what opens a wizard. */
import { screen, waitFor } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { live, robot, server, session, show } from '../../../testing/page'
import { useWizard } from '../../api/valueWizard'
import type { CatalogueBody, Edit, KeyView } from '../../api/types'
import { newHistory } from '../../document/editing/history'
import { node } from '../../document/editing/testNodes'
import { ParameterFields } from './ParameterFields'
import { blank, draftOf, useEditor } from './store'

const ID = 'x.yaml'
const EDITS = `POST /documents/${ID}/edits`
const NUMBER = { type: 'number' }
const VECTOR = { type: 'array', prefixItems: [NUMBER, NUMBER, NUMBER], unit: 'm' }
const key = (name: string, schema: KeyView['schema'], required = false): KeyView => ({ name, required, default: null, schema })
const ROBOT = key('robot', { type: 'string', cell_name: 'robot' }, true)
const TARGET = key('target', {
  type: 'object',
  properties: {
    entry: { type: 'string', entry: 'pose' },
    xyz: VECTOR,
    xyzw: { type: 'array', prefixItems: [NUMBER, NUMBER, NUMBER, NUMBER] },
    frame: { type: 'string', cell_name: 'frame', default: 'world' },
  },
})
const JOINTS = { anyOf: [{ type: 'array', items: NUMBER, joints_of: 'robot' }, { type: 'null' }] }
const WAYPOINT = { type: 'object', properties: { joints: JOINTS, pose: TARGET.schema, blend_m: NUMBER } }
const WAYPOINTS = key('waypoints', { type: 'array', items: WAYPOINT })
const FORCE = key('force_n', { ...NUMBER, unit: 'N', measured_on: 'wrench' })
const CATALOGUE: CatalogueBody = {
  states: [],
  containers: [],
  behaviors: [],
  entries: [{ kind: 'pose', name: 'tray' }],
  names: { robot: ['left', 'right'], frame: ['plate', 'world'] },
}
const ITEMS = {
  cell: 'bench',
  description: '',
  file: 'bench.yaml',
  changed: false,
  items: [{ path: 'robots/left', kind: 'robot', name: 'left', model: 'panda', owner: '', topics: [], text: '', line: 1 }],
}

function edits(): Edit[] {
  return (server().bodies(EDITS) as { edits: Edit[] }[]).flatMap((body) => body.edits)
}

function fields(parameters: Record<string, unknown>, ...keys: KeyView[]) {
  const go = node('root/go', [], { parameters, state: 'test.Go' })
  return show(<ParameterFields node={go} keys={keys} />)
}

beforeEach(() => {
  server()
    .on('GET /session', session())
    .on('GET /cell/items', ITEMS)
    .on(EDITS, new Promise(() => undefined))
  live({ robots: { left: robot({ name: 'left', mode: 'moving', activity: 'to tray' }) } })
  const start = blank(ID)
  const history = newHistory({ ...draftOf(start), document: undefined, hash: 'h1' })
  useEditor.setState({ ...start, phase: 'ready', catalogue: CATALOGUE, history }, true)
})

it('offers the robots of the cell with what they do now, finds them by typing, and takes one', async () => {
  const user = fields({}, ROBOT)
  await user.click(screen.getByLabelText('robot'))
  expect(await screen.findByText('panda, carries out to tray')).toBeInTheDocument()
  expect(screen.getByText('right')).toBeInTheDocument()
  await user.type(screen.getByLabelText('robot'), 'panda')
  expect(screen.queryByText('right')).toBeNull()
  await user.keyboard('{ArrowDown}{Enter}')
  await waitFor(() => expect(edits()).toEqual([{ edit: 'set_parameter', path: 'root/go', name: 'robot', value: 'left' }]))
})

it('keeps a name that the cell does not have, says so, and takes another one as it is typed', async () => {
  const user = fields({ robot: 'lft' }, ROBOT)
  expect(screen.getByLabelText('robot')).toHaveValue('lft')
  expect(screen.getByLabelText('robot')).toHaveAccessibleDescription('The cell has no robot “lft”; it has: left, right')
  await user.clear(screen.getByLabelText('robot'))
  await user.type(screen.getByLabelText('robot'), 'middle{Enter}')
  await waitFor(() => expect(edits()).toMatchObject([{ name: 'robot', value: 'middle' }]))
})

it('edits a target that is written out field by field, and its frame is chosen too', async () => {
  const user = fields({ target: { xyz: [1, 2, 3], frame: 'plte' } }, TARGET)
  expect(screen.getByText('The cell has no frame “plte”; it has: plate, world')).toBeInTheDocument()
  await user.click(screen.getByLabelText('target frame'))
  await user.click(screen.getByText('plate'))
  await waitFor(() => expect(edits()).toMatchObject([{ name: 'target', value: { xyz: [1, 2, 3], frame: 'plate' } }]))
})

it('goes back from a target that is written out to the entries', async () => {
  const user = fields({ target: { xyz: [1, 2, 3] } }, TARGET)
  await user.click(screen.getByText('Choose an entry instead'))
  await waitFor(() => expect(edits()).toEqual([{ edit: 'clear_parameter', path: 'root/go', name: 'target' }]))
})

it('opens the wizard that the type of a value has, for the arm of the state', async () => {
  const user = fields({ robot: 'left', target: { entry: 'tray' } }, TARGET)
  await user.click(screen.getByLabelText('Teach target'))
  const { asked } = useWizard.getState()
  expect(asked).toMatchObject({ kind: 'pose', arm: 'left', title: 'target of go', frames: ['plate', 'world'], form: 'xyzw' })
  asked?.onSet({ xyz: [0, 0, 1] })
  await waitFor(() => expect(edits()).toMatchObject([{ name: 'target', value: { xyz: [0, 0, 1] } }]))
})

it('opens the wizard of waypoints with the entries that may be some', async () => {
  const user = fields({ robot: 'left', waypoints: [{ pose: { entry: 'tray' } }] }, WAYPOINTS)
  await user.click(screen.getByLabelText('Teach waypoints'))
  const { asked } = useWizard.getState()
  expect(asked).toMatchObject({
    kind: 'waypoints',
    arm: 'left',
    entries: [{ kind: 'pose', name: 'tray' }],
    value: [{ pose: { entry: 'tray' } }],
  })
  asked?.onSet([{ joints: [0, 1] }])
  await waitFor(() => expect(edits()).toMatchObject([{ name: 'waypoints', value: [{ joints: [0, 1] }] }]))
})

const LISTED = [{ pose: { entry: 'tray' } }, { joints: [0, 1], blend_m: 0.1 }]

it('edits a waypoint field by field', async () => {
  const user = fields({ waypoints: LISTED }, WAYPOINTS)
  expect(screen.queryByLabelText('waypoints 1 blend_m')).toBeNull()
  await user.click(screen.getByText('1: joints 0.00, 1.00'))
  await user.clear(screen.getByLabelText('waypoints 1 blend_m'))
  await user.type(screen.getByLabelText('waypoints 1 blend_m'), '0.05{Enter}')
  await waitFor(() => expect(edits()).toMatchObject([{ name: 'waypoints', value: [LISTED[0], { joints: [0, 1], blend_m: 0.05 }] }]))
})

it.each([
  ['Move waypoints 1 up', [LISTED[1], LISTED[0]]],
  ['Delete waypoints 0', [LISTED[1]]],
  ['Add one to waypoints', [...LISTED, {}]],
])('has a button %s', async (label, value) => {
  const user = fields({ waypoints: LISTED }, WAYPOINTS)
  await user.click(screen.getByLabelText(label))
  await waitFor(() => expect(edits()).toEqual([{ edit: 'set_parameter', path: 'root/go', name: 'waypoints', value }]))
})

it('shows what is no list of waypoints as it is written', () => {
  fields({ waypoints: { entry: 'tray' } }, WAYPOINTS)
  expect(screen.getByLabelText('waypoints')).toHaveValue('{"entry":"tray"}')
})

it('shows the force that the arm measures beside the one that is set', async () => {
  const user = fields({ robot: 'left', force_n: 10 }, FORCE)
  await user.click(screen.getByLabelText('Show what is measured for force_n'))
  const socket = server().socket('/data')
  socket.accept()
  socket.tell({ k: 'message', topic: 'left/wrench', at_s: 1, value: { force_n: [0, 3, -4], torque_nm: [0, 0, 0] }, problem: '' })
  expect(await screen.findByText('Now 5.0 N (0.0, 3.0, -4.0)')).toBeInTheDocument()
})

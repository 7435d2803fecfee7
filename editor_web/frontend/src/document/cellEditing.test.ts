/** Fields of items, their numbers in the units of the form, the edits of a change, and where an item will be in 3D. */
import { expect, it } from 'vitest'
import type { CellDraft, CellItem, DraftItem } from '../api/types'
import { editsBetween, fieldsFor, itemAddress, itemAt, itemAtLine, itemsOfDraft, nameFault, surroundingsOf, withShape } from './cellEditing'
import { shownNumbers, withValue, writtenNumbers, type Field, type Section } from './cellFields'
import { freeName, NEW_ITEMS, newItemsOf } from './cellNewItems'
import { shownItem } from './cellShown'

const MODELS = { folders: ['bin'], robots: ['panda', 'ur10'], tools: ['panda_hand'] }
const NAMES = { fixtures: ['table'], parts: [], equipment: [], positions: {} }
const AROUND = { frames: ['world', 'table'], connectors: ['dock'], ...MODELS, ...NAMES }
const HALF_TURN = 1.5707963267948966

function item(section: Section, name: string, value = {}, line = 1): DraftItem {
  return { section, name, value, line, end_line: line + 1 }
}

function draft(change: Partial<CellDraft> = {}): CellDraft {
  const items = [
    item('fixtures', 'table', { shape: 'box', size_m: [1, 1, 0.5] }, 3),
    item('connectors', 'dock', {}, 6),
    item('connectors', 'port', {}, 8),
    item('modules', 'bin', { module: 'bin', connector: 'port' }, 11),
  ]
  return { text: '', hash: '', kind: 'cell', items, findings: [], frames: {}, parts: {}, positions: {}, ...change }
}

function numbersField(section: Section, label: string): Field & { kind: 'numbers' } {
  const field = fieldsFor(section, { shape: 'box' }, AROUND).find((each) => each.label === label)
  if (field?.kind !== 'numbers') throw new Error(label)
  return field
}

it('shows angles in degrees and writes radians; what is not changed keeps its last digit', () => {
  const turn = numbersField('frames', 'Roll, pitch, yaw')
  const shown = shownNumbers(turn, [0, 0.1, HALF_TURN])
  expect(shown[2]).toBeCloseTo(90)
  expect(writtenNumbers(turn, [0, 0.1, HALF_TURN], [45, shown[1] ?? 0, shown[2] ?? 0])).toEqual([0.785398, 0.1, HALF_TURN])
  expect(shownNumbers(turn, undefined)).toEqual([0, 0, 0])
})

it('writes a single number where the document has one, and a list for a size', () => {
  expect(writtenNumbers(numbersField('parts', 'Mass'), 0.5, [0.7])).toBe(0.7)
  const ball = fieldsFor('parts', { shape: 'sphere' }, AROUND).find((each) => each.label === 'Size')
  expect(ball?.kind === 'numbers' && writtenNumbers(ball, [0.1], [0.2])).toEqual([0.2])
})

it('gives another shape as many lengths as it needs', () => {
  expect(withShape({ shape: 'box', size_m: [0.3, 0.2, 0.1] }, 'cylinder')).toEqual({ shape: 'cylinder', size_m: [0.3, 0.2] })
  expect(withShape({ shape: 'cylinder', size_m: [0.3, 0.2] }, 'box')).toEqual({ shape: 'box', size_m: [0.3, 0.2, 0.3] })
  expect(withShape({}, 'sphere')).toEqual({ shape: 'sphere', size_m: [0.1] })
})

it('has the scale and the pieces of a mesh instead of a size, and keeps it a mesh', () => {
  const mesh = { shape: 'mesh', file: 'meshes/bin.stl', scale: 0.001 }
  const fields = fieldsFor('fixtures', mesh, AROUND)
  expect(fields.map(({ label }) => label)).toEqual([
    'Shape',
    'Metres per unit of the file',
    'Pieces at most',
    'Hollows are kept to',
    'Stands in',
    'Position',
    'Roll, pitch, yaw',
    'Colour',
  ])
  expect(fields[0]).toMatchObject({ choices: ['mesh'] })
  expect(shownItem('fixtures', mesh, draft({ frames: { world: pose(2) } }))).toMatchObject({ pose: { xyz: [2, 0, 0] }, shape: undefined })
})

it('makes the edits of what was changed, and renames last', () => {
  const table = item('fixtures', 'table', { shape: 'box', size_m: [1, 1, 0.5], color: 'x', at: { xyz: [0, 0, 0] } })
  const fields = fieldsFor('fixtures', table.value, AROUND)
  expect(editsBetween(table, table.value, 'table', fields)).toEqual([])
  const next = withValue(withValue(table.value, ['at', 'frame'], 'floor'), ['color'], undefined)
  expect(editsBetween(table, next, 'bench', fields)).toEqual([
    { edit: 'set_field', section: 'fixtures', name: 'table', field: ['at', 'frame'], value: 'floor' },
    { edit: 'set_field', section: 'fixtures', name: 'table', field: ['color'], value: null },
    { edit: 'rename_item', section: 'fixtures', name: 'table', new_name: 'bench' },
  ])
})

it('offers what something may stand in, and connectors that are free', () => {
  const frames = { table: pose(0), world: pose(0), 'bin/slot': pose(1) }
  expect(surroundingsOf(draft({ frames }), MODELS)).toEqual({
    frames: ['world', 'bin/slot', 'table'],
    connectors: ['dock'],
    ...MODELS,
    ...NAMES,
    fixtures: ['table', 'bin/slot'],
  })
  expect(surroundingsOf(draft(), MODELS).frames).toEqual(['world', 'bin', 'dock', 'port', 'table'])
})

it('gives a robot a model, a tool or none, and a base', () => {
  const arm = item('robots', 'arm', { model: 'panda', gripper: { model: 'panda_hand' } })
  const fields = fieldsFor('robots', arm.value, AROUND)
  expect(fields.map(({ label }) => label)).toEqual(['Model', 'Tool', 'Stands in', 'Position', 'Roll, pitch, yaw'])
  const bare = withValue(withValue(arm.value, ['gripper', 'model'], undefined), ['base', 'xyz'], [1, 0, 0])
  expect(editsBetween(arm, bare, 'arm', fields)).toEqual([
    { edit: 'set_field', section: 'robots', name: 'arm', field: ['gripper', 'model'], value: null },
    { edit: 'set_field', section: 'robots', name: 'arm', field: ['base', 'xyz'], value: [1, 0, 0] },
  ])
  expect(shownItem('robots', bare, draft({ frames: { world: pose(2) } }))?.pose.xyz).toEqual([3, 0, 0])
  const robot = NEW_ITEMS.find(({ section }) => section === 'robots')
  expect(robot?.value(AROUND)).toEqual({ model: 'panda', base: { xyz: [0, 0, 0] } })
  expect(robot?.obstacle({ ...AROUND, robots: [] })).toBe('no models of robots are installed')
})

it('names new items, and says why a module cannot be added', () => {
  expect(freeName('box', new Set(['box_1', 'box_2', 'box_4']))).toBe('box_3')
  expect(nameFault('box_1')).toBeUndefined()
  for (const name of ['', 'Box', '1box', 'a/b', 'ä', 'x'.repeat(65)]) expect(nameFault(name)).toBeDefined()
  const module = NEW_ITEMS.find(({ section }) => section === 'modules')
  expect(module?.obstacle(AROUND)).toBeUndefined()
  expect(module?.obstacle({ ...AROUND, connectors: [] })).toBe('every connector is taken: add one first')
  expect(module?.obstacle({ ...AROUND, folders: [] })).toBe('the project has no module.yaml')
  expect(newItemsOf('module').map(({ section }) => section)).not.toContain('modules')
})

it('finds items by their address on the page and by their lines', () => {
  const dock = draft().items[1]
  expect(dock && itemAddress(dock)).toBe('frames/dock')
  expect(itemAt(draft(), 'frames/dock')).toEqual(dock)
  expect(itemAtLine(draft(), 4)?.name).toBe('table')
  expect(itemAtLine(draft(), 5)).toBeUndefined()
})

it('shows the items of the draft with what the open cell has beside them', () => {
  const open = (path: string, owner = ''): CellItem => ({
    path,
    kind: 'fixture',
    name: path,
    model: '',
    owner,
    topics: ['t'],
    text: '',
    line: 1,
    file: '',
  })
  const cell = [
    open('robots/left'),
    { ...open('robots/left/gripper', 'robots/left'), kind: 'tool' as const },
    open('people/anna'),
    open('fixtures/table'),
    open('fixtures/gone'),
    open('fixtures/bin/tray', 'modules/bin'),
    open('fixtures/vice/jaws', 'modules/vice'),
  ]
  const right = item('robots', 'right', { model: 'ur10', gripper: { model: 'robotiq_2f85' } })
  const shown = itemsOfDraft(draft({ items: [...draft().items, right] }), cell)
  expect(shown.filter(({ path }) => path.startsWith('robots'))).toMatchObject([
    { path: 'robots/right', kind: 'robot', model: 'ur10' },
    { path: 'robots/right/gripper', kind: 'tool', model: 'robotiq_2f85', owner: 'robots/right' },
  ])
  expect(itemsOfDraft(draft(), cell).map(({ path }) => path)).toEqual([
    'people/anna',
    'fixtures/bin/tray',
    'fixtures/table',
    'connectors/dock',
    'connectors/port',
    'modules/bin',
  ])
  expect(itemsOfDraft(draft(), cell).find(({ path }) => path === 'fixtures/table')?.topics).toEqual(['t'])
  expect(itemsOfDraft(draft({ kind: 'module' }), cell).every(({ path }) => !path.startsWith('robots'))).toBe(true)
})

function pose(x: number) {
  return { xyz: [x, 0, 0] as const, xyzw: [0, 0, 0, 1] as const, frame: 'world' }
}

it('tells where an item will be in the world, in what it stands in', () => {
  const frames = draft({ frames: { world: pose(0), table: pose(2) } })
  const box = { shape: 'box', size_m: [1, 1, 1], at: { xyz: [0.5, 0, 0], frame: 'table' } }
  expect(shownItem('fixtures', box, frames)).toMatchObject({ pose: { xyz: [2.5, 0, 0] }, shape: 'box', size: [1, 1, 1] })
  expect(shownItem('frames', { parent: 'table', at: { rpy: [0, 0, HALF_TURN] } }, frames)?.pose.xyzw[3]).toBeCloseTo(Math.SQRT1_2)
  expect(shownItem('cameras', { at: [0, 0, 1], frame: 'table' }, frames)?.pose.xyz).toEqual([2, 0, 1])
  expect(shownItem('modules', { connector: 'table' }, frames)?.pose.xyz).toEqual([2, 0, 0])
  expect(shownItem('fixtures', { shape: 'tray', size_m: [1, 1, 0.2] }, frames)).toMatchObject({ pose: { xyz: [0, 0, 0.1] }, shape: 'box' })
  expect(shownItem('fixtures', { ...box, size_m: [1, 1, 0] }, frames)?.shape).toBeUndefined()
  expect(shownItem('fixtures', { at: { frame: 'nowhere' } }, frames)).toBeUndefined()
  expect(shownItem('modules', { module: 'bin', plugged: false }, frames)).toBeUndefined()
})

/** Fields of devices and bonds, what a device gets, the edits of a change of it, and where an axis ends. */
import { expect, it } from 'vitest'
import type { CellDraft, DraftItem } from '../api/types'
import { axisEnd, deviceGroups, equipmentFields, NEW_ENTRIES, outputsOf, withDriver, withJoint, withoutEntry } from './cellDevices'
import { editsBetween, fieldsFor, surroundingsOf, withField } from './cellEditing'
import { withValue } from './cellFields'
import { shownItem } from './cellShown'

const AXIS = { joint: 'slide', body: 'jaw', along: [2, 0, 0], stroke_m: 0.05, force_n: 40, speed_m_s: 0.1, output: 'valve' }
const CLAMP = {
  axes: { main: AXIS },
  sensors: { shut: { axis: 'main', at_least: 0.04 }, air: { air: true } },
  positions: { closed: { steps: [{ set: { valve: true, lamp: false } }, { pause: '1 s' }], time: '2 s' } },
}
const ITEM: DraftItem = { section: 'devices', name: 'clamp', line: 1, end_line: 9, value: CLAMP }
const JAW: DraftItem = { ...ITEM, section: 'fixtures', name: 'jaw', value: { shape: 'box', size_m: [0.1, 0.1, 0.1] } }
const DRAFT: CellDraft = {
  text: '',
  hash: '',
  kind: 'cell',
  items: [ITEM, JAW],
  findings: [],
  frames: { world: at(0), jaw: at(1), 'vice/jaw': at(2) },
  parts: { lid: at(3) },
  positions: { 'vice/jaws': ['open'] },
}
const AROUND = surroundingsOf(DRAFT, { folders: [], robots: [], tools: [] })

function at(x: number) {
  return { xyz: [x, 0, 0] as const, xyzw: [0, 0, 0, 1] as const, frame: 'world' }
}

function labels(group: string, value = CLAMP): readonly string[] {
  return (
    deviceGroups(value, AROUND)
      .find((each) => each.title === group)
      ?.fields.map(({ label }) => label) ?? []
  )
}

it('knows what a device can name: fixtures, parts, and positions of others', () => {
  expect(AROUND).toMatchObject({ fixtures: ['jaw', 'vice/jaw'], parts: [], positions: { 'vice/jaws': ['open'], clamp: ['closed'] } })
  expect(outputsOf(CLAMP)).toEqual(['valve', 'lamp'])
})

it('has a group for each axis, sensor and position, in the units of its joint', () => {
  expect(deviceGroups(CLAMP, AROUND).map(({ title }) => title)).toEqual([
    '',
    'Axis main',
    'Sensor shut',
    'Sensor air',
    'Position closed',
    'Interlocks',
  ])
  expect(labels('Axis main')).toContain('Force at rest')
  expect(labels('Sensor air')).toEqual(['On while there is air'])
  const turned = withJoint(CLAMP, 'main', 'hinge')
  expect(turned).toMatchObject({ axes: { main: { joint: 'hinge', body: 'jaw', torque_nm: 5, output: 'valve' } } })
  expect(labels('Axis main', turned as typeof CLAMP)).toContain('Torque at rest')
  expect(JSON.stringify(turned)).not.toContain('stroke_m')
})

it('edits one number of an axis alone, takes a sensor away, and renames last', () => {
  const next = withoutEntry(withValue(CLAMP, ['axes', 'main', 'force_n'], 55), 'sensors', 'shut')
  expect(editsBetween(ITEM, next, 'gripper', [], { 'axes.main': 'jaw', 'sensors.shut': 'gone' })).toEqual([
    { edit: 'set_field', section: 'devices', name: 'clamp', field: ['axes', 'main', 'force_n'], value: 55 },
    { edit: 'set_field', section: 'devices', name: 'clamp', field: ['sensors', 'shut'], value: null },
    { edit: 'rename_field', section: 'devices', name: 'clamp', field: ['axes', 'main'], new_name: 'jaw' },
    { edit: 'rename_item', section: 'devices', name: 'clamp', new_name: 'gripper' },
  ])
})

it('gives a device an axis for a fixture that none moves, and a sensor only at an axis', () => {
  const [axis, , , sensor] = NEW_ENTRIES
  expect(axis?.value(CLAMP, AROUND)).toMatchObject({ body: 'vice/jaw', output: 'valve' })
  expect(axis?.obstacle(CLAMP, { ...AROUND, fixtures: [] })).toBe('add a fixture that it moves')
  expect(sensor?.obstacle({}, AROUND)).toBe('add an axis first')
})

it('gives equipment a server or simulates it', () => {
  expect(equipmentFields({ pins: 'a.yaml' }).map(({ label }) => label)).toEqual(['Driver', 'Pins'])
  const served = withDriver({ pins: 'a.yaml' }, 'equipment')
  expect(served).toEqual({ pins: 'a.yaml', driver: { kind: 'equipment', host: '127.0.0.1', port: 7391 } })
  const [driver] = equipmentFields(served)
  expect(driver && withField(served, driver, 'sim')).toEqual({ pins: 'a.yaml', driver: undefined })
})

it('shows where an axis ends and where a bond is', () => {
  expect(axisEnd(CLAMP, 'main', DRAFT)?.pose.xyz).toEqual([1.05, 0, 0])
  expect(shownItem('devices', CLAMP, DRAFT)).toMatchObject({ pose: { xyz: [1.05, 0, 0] }, shape: 'box' })
  const turned = axisEnd({ axes: { main: { ...AXIS, joint: 'hinge', along: [0, 0, 1], stroke_rad: Math.PI / 2 } } }, '', DRAFT)
  expect(turned?.pose.xyzw[2]).toBeCloseTo(Math.SQRT1_2)
  expect(axisEnd({ axes: { main: { ...AXIS, along: [0, 0, 0] } } }, '', DRAFT)).toBeUndefined()
  expect(shownItem('bonds', { part: 'lid', at_m: [0, 0, 0.1] }, DRAFT)?.pose.xyz).toEqual([3, 0, 0.1])
  expect(fieldsFor('bonds', {}, AROUND).find(({ label }) => label === 'Joined to')).toMatchObject({ choices: ['jaw', 'vice/jaw'] })
})

/** What fields offer, and which names nothing has. */
import { expect, it } from 'vitest'
import type { CellItem, RobotLive } from '../../api/types'
import { editFieldOf } from './fields'
import { offersOf, unknownName, type Surroundings } from './offers'

const NAMES = {
  robot: ['left', 'right'],
  gripper: ['left'],
  link: ['left/hand', 'left/arm', 'leftover/x'],
  output: ['left/0', 'left/1', 'left/gripper'],
  part: ['plate'],
  frame: ['left/hand', 'plate', 'world'],
  obstacle: ['table'],
}

const around = (told: Partial<Surroundings> = {}): Surroundings => ({
  names: NAMES,
  entries: [
    { kind: 'pose', name: 'tray' },
    { kind: 'joints', name: 'home' },
  ],
  given: {},
  parameters: { arm: { type: 'string', default: 'left' } },
  added: [],
  isOpenCell: true,
  open: undefined,
  ...told,
})

const key = (schema: Record<string, unknown>) => editFieldOf({ name: 'x', required: true, default: null, schema })
const names = (field: ReturnType<typeof key>, told: Partial<Surroundings> = {}) => offersOf(field, around(told))?.map((each) => each.text)
const item = (kind: CellItem['kind'], path: string, model: string): CellItem => ({
  path,
  kind,
  name: path.split('/')[1] ?? '',
  model,
  owner: '',
  topics: [],
  text: '',
  line: 0,
  file: '',
})

const ROBOT = key({ type: 'string', cell_name: 'robot' })
const LINK = key({ anyOf: [{ type: 'string', cell_name: 'link', of: 'robot' }, { type: 'null' }] })
const OUTPUT = key({ type: 'integer', cell_name: 'output', of: 'robot' })
const OBSTACLE = key({ type: 'string', cell_name: 'obstacle' })
const LABEL = key({ type: 'string', cell_label: 'part' })
const ENTRY = key({ type: 'string', entry: 'pose' })
const NEW_ENTRY = key({ type: 'string', new_entry: 'pose' })
const STORED = key({ type: 'string', entry_of: 'kind' })
const KIND = key({ type: 'string', entry_kind: true, examples: ['joints', 'record'] })

it('offers the names of a kind, of a robot those of the robot that is given, also by a parameter', () => {
  expect(names(ROBOT)).toEqual(['left', 'right'])
  expect(names(LINK, { given: { robot: 'left' } })).toEqual(['hand', 'arm'])
  expect(names(LINK, { given: { robot: '${arm}' } })).toEqual(['hand', 'arm'])
  expect(names(LINK)).toEqual([])
  expect(names(key({ type: 'string' }))).toBeUndefined()
  expect(names(key({ type: 'string', cell_name: 'frame', or: ['part'] }))).toEqual(['part', 'left/hand', 'plate', 'world'])
})

it('offers outputs by number where a number is asked for', () => {
  expect(names(OUTPUT, { given: { robot: 'left' } })).toEqual(['0', '1'])
})

it('offers entries of a kind, and of the kind that another parameter names', () => {
  expect(names(ENTRY)).toEqual(['tray'])
  expect(names(STORED, { given: { kind: 'joints' } })).toEqual(['home'])
  expect(offersOf(NEW_ENTRY, around())).toEqual([{ text: 'tray', detail: 'exists' }])
  expect(offersOf(KIND, around())).toEqual([
    { text: 'joints', detail: '1 entry' },
    { text: 'record', detail: '' },
    { text: 'pose', detail: '1 entry' },
  ])
})

it('says what each thing is and how it is now', () => {
  const robots = { left: { name: 'left', mode: 'moving', activity: 'to tray' } as RobotLive }
  const state = {
    k: 'cell' as const,
    poses: {},
    cameras: {},
    tools: { left: { held: true, part: 'plate' } },
    devices: {},
    modules: {},
  }
  const items = [
    item('robot', 'robots/left', 'panda'),
    item('tool', 'robots/left/gripper', 'panda_hand'),
    item('part', 'parts/plate', 'box'),
  ]
  const open = { items, now: { robots, state }, outputs: [true, false] }
  const words = (field: ReturnType<typeof key>, given = {}) => offersOf(field, around({ open, given }))?.map((each) => each.detail)
  expect(words(ROBOT)).toEqual(['panda, carries out to tray', ''])
  expect(words(key({ type: 'string', cell_name: 'gripper' }))).toEqual(['panda_hand, holds plate'])
  expect(words(key({ type: 'string', cell_name: 'part' }))).toEqual(['box, held by left'])
  expect(words(key({ type: 'string', cell_name: 'frame' }))).toEqual(['link of left', 'part, held by left', 'the world'])
  expect(words(OUTPUT, { robot: 'left' })).toEqual(['on', 'off'])
})

it('names what nothing has, with what there is', () => {
  expect(unknownName(ROBOT, 'lft', around())).toBe('The cell has no robot “lft”; it has: left, right')
  expect(unknownName(ENTRY, 'tary', around())).toBe('The store has no pose entry “tary”')
  expect(unknownName(OUTPUT, 7, around({ given: { robot: 'left' } }))).toContain('no output “7”')
})

it.each([
  ['a name that is there', ROBOT, 'left', {}],
  ['an expression', ROBOT, '${arm}', {}],
  ['a kind that the cell does not list', key({ type: 'string', cell_name: 'planner' }), 'any', {}],
  ['a link of a robot without a model', LINK, 'flange', { given: { robot: 'right' } }],
  ['a word for messages', LABEL, 'blue box', {}],
  ['an entry to be made', NEW_ENTRY, 'fresh', {}],
  ['what a state adds', OBSTACLE, 'box_1', { added: ['box_1'] }],
  ['an entry of a cell that is not open', ENTRY, 'tary', { isOpenCell: false }],
])('takes %s', (_, field, value, told) => {
  expect(unknownName(field, value, around(told))).toBeUndefined()
})

it('offers what a state adds, and says of another obstacle that none does', () => {
  expect(offersOf(OBSTACLE, around({ added: ['box_1'] }))?.at(-1)).toEqual({ text: 'box_1', detail: 'added by a state' })
  expect(unknownName(OBSTACLE, 'box_2', around())).toContain('no state of this behavior adds it')
})

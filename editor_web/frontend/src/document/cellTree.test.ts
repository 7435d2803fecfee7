/** The tree of a cell, and its state in words. */
import { expect, it } from 'vitest'
import type { CellItem, CellStateFrame, RobotLive } from '../api/types'
import { ancestorsOf, cellTree, nodeAt, orientationText, placeOf, poseOf, positionText, stateWords, type CellNode } from './cellTree'

const ROBOT: RobotLive = {
  name: 'left',
  mode: 'moving',
  activity: 'move_pose',
  error: '',
  speed_override: 1,
  controller: '',
  path: null,
  separation: '',
}
const STATE: CellStateFrame = {
  k: 'cell',
  poses: {
    plate: { xyz: [0.1, -0.00001, 0], xyzw: [0, 0, 0, 1], frame: 'world' },
    'left/tool': { xyz: [0, 0, 1], xyzw: [1, 0, 0, 0], frame: 'world' },
  },
  cameras: { eye: { xyz: [0, 0, 2], xyzw: [0, 0, 0, 1], frame: 'world' } },
  tools: { left: { held: true, part: 'disk' } },
  devices: {},
  modules: { trolley: '', rack: 'east' },
}

function item(path: string, kind: CellItem['kind'], told: Partial<CellItem> = {}): CellItem {
  return { path, kind, name: path.split('/').at(-1) ?? '', model: 'box', owner: '', topics: [], text: '', line: 1, file: '', ...told }
}

const ITEMS = [
  item('robots/left', 'robot', { model: 'panda' }),
  item('robots/left/gripper', 'tool', { name: 'left', model: 'panda_hand', owner: 'robots/left' }),
  item('parts/plate', 'part'),
  item('parts/disk', 'part'),
  item('cameras/eye', 'camera', { model: 'sim' }),
  item('world', 'world', { model: 'mujoco' }),
  item('frames/dock', 'frame', { model: 'in table_top' }),
]
const TREE = cellTree(ITEMS, ['plate', 'disk', 'left/tool', 'left/link0', 'table_top'])

function written(nodes: readonly CellNode[], depth = 0): string[] {
  return nodes.flatMap((node) => [
    `${'  '.repeat(depth)}${[node.name, node.detail].filter(Boolean).join(' ')}`,
    ...written(node.children, depth + 1),
  ])
}

function words(address: string, mode = 'moving'): string | undefined {
  const node = nodeAt(TREE, address)
  return node && stateWords(node, { robots: { left: { ...ROBOT, mode } }, state: STATE })?.words
}

it('puts tools below robots and frames below what they belong to, and no empty group', () => {
  expect(written(TREE)).toEqual([
    'Robots',
    '  left panda',
    '    gripper panda_hand',
    'Parts',
    '  plate box',
    '  disk box',
    'Cameras',
    '  eye sim',
    'World and store',
    '  world mujoco',
    'Frames',
    '  left',
    '    link0',
    '    tool',
    '  dock in table_top',
    '  table_top',
  ])
})

it('shows a frame that the document names once, with its lines, whether or not its pose is known', () => {
  for (const tree of [TREE, cellTree(ITEMS, ['dock'])]) {
    expect(nodeAt(tree, 'frames/dock')?.item?.path).toBe('frames/dock')
    expect(tree.at(-1)?.children.filter((node) => node.name === 'dock')).toHaveLength(1)
  }
})

it('puts what stands on a module below it, by its name there, and its frames among the frames', () => {
  const docked = [
    item('modules/vice', 'module', { model: 'vice' }),
    item('fixtures/vice/jaw', 'fixture', { name: 'vice/jaw', owner: 'modules/vice' }),
    item('parts/vice/block', 'part', { name: 'vice/block', owner: 'modules/vice' }),
    item('frames/vice/slot', 'frame', { name: 'vice/slot', owner: 'modules/vice', model: 'in vice/jaw' }),
  ]
  const tree = cellTree(docked, ['vice', 'vice/slot', 'vice/block'])
  expect(nodeAt(tree, 'modules/vice')?.children.map((node) => [node.address, node.name])).toEqual([
    ['fixtures/vice/jaw', 'jaw'],
    ['parts/vice/block', 'block'],
  ])
  expect(nodeAt(tree, 'frames/vice/slot')?.detail).toBe('in vice/jaw')
  expect(nodeAt(tree, 'frames/vice/block')).toBeUndefined()
})

it('finds a line, and what is above it', () => {
  expect(nodeAt(TREE, 'frames/left/tool')?.kind).toBe('frame')
  expect(nodeAt(TREE, 'robots/right')).toBeUndefined()
  expect(ancestorsOf(TREE, 'frames/left/tool')).toEqual(['group:frames', 'group:frames/left'])
  expect(ancestorsOf(TREE, 'robots/left/gripper')).toEqual(['group:Robots', 'robots/left'])
})

it('says what each item does, holds or where it is', () => {
  expect(words('robots/left')).toBe('carries out move_pose')
  expect(words('robots/left', 'fault')).toBe('fault move_pose')
  expect(words('robots/left/gripper')).toBe('holds disk')
  expect(words('parts/disk')).toBe('held by left')
  expect(words('parts/plate')).toBe('0.100, 0.000, 0.000 m')
  expect(words('cameras/eye')).toBe('0.000, 0.000, 2.000 m')
  expect(words('frames/left/tool')).toBe('0.000, 0.000, 1.000 m')
  expect(words('world')).toBeUndefined()
})

it('says nothing of what is not known', () => {
  for (const address of ['robots/left', 'robots/left/gripper', 'parts/plate', 'cameras/eye', 'frames/left/tool']) {
    const node = nodeAt(TREE, address)
    expect(node && stateWords(node, { robots: {}, state: undefined })).toBeUndefined()
  }
})

it('knows where the camera of the 3D view can turn to', () => {
  const places = ['robots/left', 'robots/left/gripper', 'parts/plate', 'frames/left/tool', 'world', 'group:Robots'].map((address) => {
    const node = nodeAt(TREE, address)
    return node && placeOf(node)
  })
  expect(places).toEqual(['left', 'left', 'plate', 'left/tool', undefined, undefined])
})

it('writes a pose in metres and degrees', () => {
  const node = nodeAt(TREE, 'frames/left/tool')
  const pose = node && poseOf(node, STATE)
  expect(pose && [positionText(pose), orientationText(pose)]).toEqual(['0.000, 0.000, 1.000 m', '180.0°, 0.0°, 0.0°'])
})

it.each([
  ['trolley', 'not plugged'],
  ['rack', 'at east'],
])('says of the module %s: %s', (name, said) => {
  const [module] = cellTree([item(`modules/${name}`, 'module')], [])[0]?.children ?? []
  expect(module && stateWords(module, { robots: {}, state: STATE })).toEqual({ words: said, look: 'idle' })
})

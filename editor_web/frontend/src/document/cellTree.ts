/** The tree of a cell: its items by kind, a tool below its robot, what stands on a module below that, and the frames by what they belong to. Pure. */
import type { CellItem, CellStateFrame, DeviceNow, Pose, RobotLive } from '../api/types'
import { deviceMode } from './devices'
import { lookup, type Dict } from './dict'
import { modeWords, robotLook } from './robotMode'
import type { Status } from './runState'
import { degrees, rollPitchYaw } from './teaching'
import { firstOfPath, nameOfPath, restOfPath } from './path'

export type NodeKind = CellItem['kind'] | 'group'

/** One line of the tree; `address` is unique in it, and that of the item where it is one. */
export interface CellNode {
  readonly address: string
  readonly kind: NodeKind
  readonly name: string
  /** Said with the name: the model of a robot, the shape of a part. */
  readonly detail: string
  readonly item: CellItem | undefined
  readonly children: readonly CellNode[]
}

/** What is known of a cell at this moment. */
export interface CellNow {
  readonly robots: Dict<RobotLive>
  readonly state: CellStateFrame | undefined
}

/** The group of each kind of item; a tool stands below the robot that carries it, a frame among all frames. */
const GROUP_OF: Readonly<Record<Exclude<CellItem['kind'], 'tool' | 'frame'>, string>> = {
  robot: 'Robots',
  equipment: 'Equipment',
  module: 'Modules',
  device: 'Devices',
  bond: 'Bonds',
  fixture: 'Fixtures',
  part: 'Parts',
  camera: 'Cameras',
  person: 'People',
  world: 'World and store',
  occupancy: 'World and store',
  store: 'World and store',
}
const GROUPS = [...new Set(Object.values(GROUP_OF))]
const FRAMES = 'frames'

/** The tree; what is empty has no group. `frames` are all frames of the cell by name, parts among them. */
export function cellTree(items: readonly CellItem[], frames: readonly string[]): readonly CellNode[] {
  const groups = GROUPS.map((name) => {
    const own = items.filter((item) => !item.owner && item.kind !== 'tool' && item.kind !== 'frame' && GROUP_OF[item.kind] === name)
    return group(
      `group:${name}`,
      name,
      own.map((item) => nodeOf(item, items)),
    )
  })
  return [...groups, framesOf(items, frames)].filter((each) => each.children.length > 0)
}

function nodeOf(item: CellItem, items: readonly CellItem[]): CellNode {
  const children = items.filter((other) => other.owner === item.path && other.kind !== 'frame').map((other) => nodeOf(other, items))
  // A tool has no name of its own in a cell: it is the gripper of its robot. What stands on a module is named below it.
  const name = item.kind === 'tool' ? nameOfPath(item.path) : item.owner ? restOfPath(item.name) : item.name
  return { address: item.path, kind: item.kind, name, detail: item.model === name ? '' : item.model, item, children }
}

/** Frames below their robot: `left/flange` below `left`; a part is a frame too, but it is among the parts already; frames that the document names have its lines. */
function framesOf(items: readonly CellItem[], frames: readonly string[]): CellNode {
  const parts = new Set(items.filter((item) => item.kind === 'part').map((item) => item.name))
  const named = new Map(items.filter((item) => item.kind === 'frame').map((item) => [item.name, item]))
  const byOwner = new Map<string, CellNode[]>()
  for (const frame of [...new Set([...frames, ...named.keys()])].filter((each) => !parts.has(each)).toSorted()) {
    const [owner, rest] = [firstOfPath(frame), restOfPath(frame)]
    const item = named.get(frame)
    const node = {
      address: `${FRAMES}/${frame}`,
      kind: 'frame',
      name: rest || owner,
      detail: item?.model ?? '',
      item,
      children: [],
    } as const
    const own = rest ? owner : ''
    byOwner.set(own, [...(byOwner.get(own) ?? []), node])
  }
  const single = byOwner.get('') ?? []
  const owners = [...byOwner].filter(([owner]) => owner)
  return group(`group:${FRAMES}`, 'Frames', [...owners.map(([owner, nodes]) => group(`group:${FRAMES}/${owner}`, owner, nodes)), ...single])
}

function group(address: string, name: string, children: readonly CellNode[]): CellNode {
  return { address, kind: 'group', name, detail: '', item: undefined, children }
}

/** The line of the tree with an address. */
export function nodeAt(tree: readonly CellNode[], address: string): CellNode | undefined {
  for (const node of tree) {
    const found = node.address === address ? node : nodeAt(node.children, address)
    if (found) return found
  }
  return undefined
}

/** The addresses on the way to a line of the tree, without its own. */
export function ancestorsOf(tree: readonly CellNode[], address: string): readonly string[] {
  for (const node of tree) {
    if (node.children.some((child) => child.address === address)) return [node.address]
    const below = ancestorsOf(node.children, address)
    if (below.length > 0) return [node.address, ...below]
  }
  return []
}

/** The arm or frame whose place the 3D view can turn to. */
export function placeOf(node: CellNode): string | undefined {
  switch (node.kind) {
    case 'robot':
    case 'tool':
    case 'part':
      return node.item?.name
    case 'frame':
      return node.address.slice(FRAMES.length + 1)
    default:
      return undefined
  }
}

/** The pose of an item in the world now, where a message tells it. */
export function poseOf(node: CellNode, state: CellStateFrame | undefined): Pose | undefined {
  if (node.kind === 'camera') return state && lookup(state.cameras, node.name)
  if (node.kind !== 'part' && node.kind !== 'frame') return undefined
  return state && lookup(state.poses, placeOf(node) ?? '')
}

/** The arm whose tool holds a part. */
export function holderOf(part: string, state: CellStateFrame | undefined): string | undefined {
  return Object.entries(state?.tools ?? {}).find(([, tool]) => tool?.held && tool.part === part)?.[0]
}

/** A robot, tool or equipment that is real, as its driver tells it; a tool is below its robot, by the name of its kind. */
export function deviceOf(node: CellNode, state: CellStateFrame | undefined): DeviceNow | undefined {
  const name = node.item?.name ?? ''
  if (node.kind === 'robot' || node.kind === 'equipment') return state && lookup(state.devices, name)
  if (node.kind !== 'tool') return undefined
  return Object.entries(state?.devices ?? {}).find(([address]) => address.startsWith(`${name}/`))?.[1]
}

/** The state of an item in a few words, with its look; undefined where it has none, or nothing is known. */
export function stateWords(node: CellNode, now: CellNow): { readonly words: string; readonly look: Status } | undefined {
  const name = node.item?.name ?? ''
  switch (node.kind) {
    case 'robot': {
      const robot = lookup(now.robots, name)
      const device = deviceOf(node, now.state)
      if (device && !device.state.enabled) return deviceMode(device.state)
      return robot && { words: [modeWords(robot), robot.activity].filter(Boolean).join(' '), look: robotLook(robot.mode) }
    }
    case 'tool': {
      const device = deviceOf(node, now.state)
      if (device && !device.state.enabled) return deviceMode(device.state)
      const tool = now.state && lookup(now.state.tools, name)
      if (!tool) return undefined
      return { words: tool.held ? `holds ${tool.part === '?' || !tool.part ? 'a part' : tool.part}` : 'holds nothing', look: 'idle' }
    }
    case 'equipment': {
      const device = deviceOf(node, now.state)
      if (!device) return undefined
      return device.state.enabled ? { words: 'enabled', look: 'idle' } : deviceMode(device.state)
    }
    case 'part': {
      const holder = holderOf(name, now.state)
      const pose = poseOf(node, now.state)
      const words = holder ? `held by ${holder}` : pose && positionText(pose)
      return words === undefined ? undefined : { words, look: 'idle' }
    }
    case 'module': {
      const connector = now.state && lookup(now.state.modules, name)
      if (connector === undefined) return undefined
      return { words: connector ? `at ${connector}` : 'not plugged', look: 'idle' }
    }
    default: {
      const pose = poseOf(node, now.state)
      return pose && { words: positionText(pose), look: 'idle' }
    }
  }
}

/** A position in metres to the millimetre: `0.550, 0.000, 0.026 m`. */
export function positionText({ xyz }: Pose): string {
  return `${xyz.map((each) => fixed(each, 3)).join(', ')} m`
}

/** Roll, pitch and yaw of an orientation in degrees. */
export function orientationText({ xyzw }: Pose): string {
  const angles = rollPitchYaw(xyzw).map((each) => fixed(degrees(each), 1))
  return `${angles.join('°, ')}°`
}

/** Rounded without the sign of a zero: noise around it must not flicker. */
function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits)
  return Number(text) === 0 ? text.replace('-', '') : text
}

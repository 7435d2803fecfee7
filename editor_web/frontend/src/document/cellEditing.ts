/** What can be edited of an item of a cell document: its fields, what a new one begins with, and the edits that change it. Pure. */
import type { CellDraft, CellEditsBody, CellItem, DraftItem } from '../api/types'
import { bondFields, deviceGroups, equipmentFields, withDriver, withJoint } from './cellDevices'
import {
  differences,
  isSame,
  numbersAt,
  numbersOf,
  valueAt,
  withValue,
  type Field,
  type FieldGroup,
  type Section,
  type Surroundings,
} from './cellFields'
import { fieldsOf, lookup, type Dict } from './dict'
import { firstOfPath } from './path'
import { WORLD } from './poses'

type Edit = CellEditsBody['edits'][number]

const XYZ = ['x', 'y', 'z'] as const
const SIZES: Dict<readonly string[]> = {
  box: XYZ,
  tray: XYZ,
  cylinder: ['diameter', 'length'],
  sphere: ['diameter'],
}
const SHAPES: Readonly<Record<'fixtures' | 'parts', readonly string[]>> = {
  fixtures: ['box', 'cylinder', 'tray'],
  parts: ['box', 'cylinder', 'sphere'],
}
const ORIGIN = [0, 0, 0] as const
const MESH_FIELDS: readonly Field[] = [
  { ...numbersAt('Metres per unit of the file', ['scale'], ['scale'], 'm', 1), minimum: 0 },
  { ...numbersAt('Pieces at most', ['decomposition', 'parts'], ['pieces'], '', 64), minimum: 1 },
  { ...numbersAt('Hollows are kept to', ['decomposition', 'error_m'], ['error'], 'm', 0.005), minimum: 0 },
]
const FIRST_SIZE_M = 0.1
const NO_TOOL = 'no tool'
const NO_PINS = 'no equipment'

/** The names of the lengths of a shape. */
export function sizeNames(shape: unknown): readonly string[] {
  return (typeof shape === 'string' ? lookup(SIZES, shape) : undefined) ?? XYZ
}

/** The fields of an item, whose value tells its shape. */
export function fieldsFor(section: Section, value: Dict<unknown>, around: Surroundings): readonly Field[] {
  const { frames, connectors, folders } = around
  const place = (label: string, path: readonly string[]): Field => ({ kind: 'choice', path, label, usual: WORLD, choices: frames })
  const position = (label: string, ...path: string[]): Field => numbersAt(label, path, XYZ, 'm', ORIGIN)
  const turn = (...path: string[]): Field => ({ ...numbersAt('Roll, pitch, yaw', path, ['r', 'p', 'y'], '°', ORIGIN), isAngle: true })
  switch (section) {
    case 'robots':
      return [
        { kind: 'choice', path: ['model'], label: 'Model', usual: '', choices: around.robots },
        { kind: 'choice', path: ['gripper', 'model'], label: 'Tool', usual: NO_TOOL, choices: [NO_TOOL, ...around.tools], none: NO_TOOL },
        place('Stands in', ['base', 'frame']),
        position('Position', 'base', 'xyz'),
        turn('base', 'rpy'),
      ]
    case 'fixtures':
    case 'parts': {
      const shape = lookup(value, 'shape')
      return [
        // A mesh stays one: its file is in the text.
        { kind: 'choice', path: ['shape'], label: 'Shape', usual: 'box', choices: shape === 'mesh' ? [shape] : SHAPES[section] },
        ...(shape === 'mesh' ? MESH_FIELDS : [{ ...numbersAt('Size', ['size_m'], sizeNames(shape), 'm', undefined), minimum: 0 }]),
        ...(shape === 'tray' ? [{ ...numbersAt('Wall', ['wall_m'], ['wall'], 'm', 0.005), minimum: 0 }] : []),
        place('Stands in', ['at', 'frame']),
        position('Position', 'at', 'xyz'),
        turn('at', 'rpy'),
        ...(section === 'parts'
          ? ([
              { ...numbersAt('Mass', ['mass_kg'], ['mass'], 'kg', undefined), minimum: 0 },
              { kind: 'switch', path: ['magnetic'], label: 'Magnetic', usual: false },
            ] as const)
          : []),
        { kind: 'colour', path: ['color'], label: 'Colour', usual: undefined },
      ]
    }
    case 'cameras':
      return [
        place('Stands in', ['frame']),
        position('Position', 'at'),
        position('Looks at', 'look_at'),
        { ...numbersAt('Field of view', ['fov_rad'], ['angle'], '°', 1), isAngle: true, minimum: 0 },
        { ...numbersAt('Images', ['rate_hz'], ['rate'], '1/s', 10), minimum: 0 },
      ]
    case 'frames':
    case 'connectors':
      return [place('Stands in', ['parent']), position('Position', 'at', 'xyz'), turn('at', 'rpy')]
    case 'modules':
      return [
        { kind: 'choice', path: ['module'], label: 'Module', usual: '', choices: folders },
        { kind: 'choice', path: ['connector'], label: 'Docked to', usual: '', choices: connectors },
        { kind: 'switch', path: ['plugged'], label: 'Plugged when the cell is opened', usual: true },
        ...(around.equipment.length > 0
          ? ([
              {
                kind: 'choice',
                path: ['equipment'],
                label: 'Pins of',
                usual: NO_PINS,
                choices: [NO_PINS, ...around.equipment],
                none: NO_PINS,
              },
            ] as const)
          : []),
      ]
    case 'equipment':
      return equipmentFields(value)
    case 'devices':
      return deviceGroups(value, around).flatMap((each) => each.fields)
    case 'bonds':
      return bondFields(around)
  }
}

/** The fields of an item, those that belong together in a group. */
export function groupsFor(section: Section, value: Dict<unknown>, around: Surroundings): readonly FieldGroup[] {
  return section === 'devices' ? deviceGroups(value, around) : [{ title: '', fields: fieldsFor(section, value, around) }]
}

/** The value after a field was set; another shape, joint or driver has other fields. */
export function withField(value: Dict<unknown>, { path }: Field, made: unknown): Dict<unknown> {
  const key = path.join('.')
  if (key === 'shape' && typeof made === 'string') return withShape(value, made)
  if (key === 'driver.kind') return withDriver(value, made)
  if (path[0] === 'axes' && path[1] !== undefined && path[2] === 'joint') return withJoint(value, path[1], made)
  return withValue(value, path, made)
}

/** Another shape needs other lengths: those that both have stay. */
export function withShape(value: Dict<unknown>, shape: string): Dict<unknown> {
  const before = numbersOf(lookup(value, 'size_m'))
  const size = sizeNames(shape).map((_, at) => before[at] ?? before[0] ?? FIRST_SIZE_M)
  return { ...value, shape, size_m: size }
}

/** Sections in whose items entries are added and removed. */
const OPEN_SECTIONS: ReadonlySet<Section> = new Set(['devices', 'equipment'])

/**
 * The edits that make the second value of the first one; new names come last, as the others are of the old ones.
 * `entryNames` are those of what a device has, by group and name: `axes.main`.
 */
export function editsBetween(
  { section, name, value }: Pick<DraftItem, 'section' | 'name' | 'value'>,
  next: Dict<unknown>,
  newName: string,
  fields: readonly Field[],
  entryNames: Dict<string> = {},
): readonly Edit[] {
  const changed = OPEN_SECTIONS.has(section)
    ? differences(value, next)
    : fields
        .filter(({ path }) => !isSame(valueAt(value, path), valueAt(next, path)))
        .map(({ path }) => [path, valueAt(next, path)] as const)
  const edits = changed.map(([path, made]): Edit => ({ edit: 'set_field', section, name, field: path, value: made ?? null }))
  const renamed = Object.entries(entryNames).flatMap(([key, to]): Edit[] => {
    const [group = '', from = ''] = key.split('.')
    const isThere = lookup(fieldsOf(lookup(next, group)), from) !== undefined
    return isThere && to !== from ? [{ edit: 'rename_field', section, name, field: [group, from], new_name: to }] : []
  })
  const all = [...edits, ...renamed]
  return newName === name ? all : [...all, { edit: 'rename_item', section, name, new_name: newName }]
}

/** Why a name cannot be given; undefined where it can. The server knows which are taken. */
export function nameFault(name: string): string | undefined {
  return /^[a-z][a-z0-9_]{0,63}$/.test(name) ? undefined : 'Lower-case letters, digits and _'
}

/** What the items of a draft can be related to; `folders` are those of all modules, beside the installed models. */
export function surroundingsOf(
  { items, frames, parts, positions, kind }: CellDraft,
  { folders, robots, tools }: Pick<Surroundings, 'folders' | 'robots' | 'tools'>,
): Surroundings {
  const known = Object.keys(frames)
  const carriers = items.filter(
    ({ section }) => section === 'frames' || section === 'fixtures' || section === 'connectors' || section === 'modules',
  )
  // While the text has errors nobody knows what stands on its modules.
  const all = known.length > 0 ? known : [WORLD, ...carriers.map(({ name }) => name)]
  const used = new Set(items.filter(({ section }) => section === 'modules').map(({ value }) => lookup(value, 'connector')))
  const connectors = items.filter(({ section, name }) => section === 'connectors' && !used.has(name)).map(({ name }) => name)
  const named = (section: Section) => items.filter((each) => each.section === section).map(({ name }) => name)
  const below = (names: readonly string[]) => names.filter((each) => each.includes('/'))
  return {
    frames: kind === 'module' ? all : all.toSorted(byWorldFirst),
    connectors,
    folders,
    robots,
    tools,
    fixtures: [...named('fixtures'), ...below(known)],
    parts: [...named('parts'), ...below(Object.keys(parts))],
    equipment: named('equipment'),
    positions: {
      ...positions,
      ...Object.fromEntries(
        items
          .filter(({ section }) => section === 'devices')
          .map(({ name, value }) => [name, Object.keys(fieldsOf(lookup(value, 'positions')))]),
      ),
    },
  }
}

function byWorldFirst(a: string, b: string): number {
  return Number(b === WORLD) - Number(a === WORLD) || a.localeCompare(b)
}

/** The address of an item on the page of the cell: connectors are among the frames there. */
export function itemAddress({ section, name }: Pick<DraftItem, 'section' | 'name'>): string {
  return `${section === 'connectors' ? 'frames' : section}/${name}`
}

export function itemAt(draft: CellDraft, address: string): DraftItem | undefined {
  return draft.items.find((each) => itemAddress(each) === address)
}

/** The item that a line of the text belongs to. */
export function itemAtLine(draft: CellDraft, line: number): DraftItem | undefined {
  return draft.items.find((each) => each.line <= line && line <= each.end_line)
}

const KINDS: Readonly<Record<Section, CellItem['kind']>> = {
  robots: 'robot',
  fixtures: 'fixture',
  parts: 'part',
  cameras: 'camera',
  frames: 'frame',
  connectors: 'frame',
  modules: 'module',
  equipment: 'equipment',
  devices: 'device',
  bonds: 'bond',
}

/** The items of the tree while a document is edited: those of the draft, and of the cell what it says beside them. */
export function itemsOfDraft(draft: CellDraft, open: readonly CellItem[]): readonly CellItem[] {
  const modules = new Set(draft.items.filter(({ section }) => section === 'modules').map(({ name }) => `modules/${name}`))
  const editable = new Set<string>(Object.keys(KINDS))
  const beside =
    draft.kind === 'module' ? [] : open.filter((each) => (each.owner ? modules.has(each.owner) : !editable.has(firstOfPath(each.path))))
  const own = draft.items.flatMap((item): readonly CellItem[] => {
    const { section, name, line, value } = item
    const drawn = (path: string, kind: CellItem['kind'], model: string, owner: string): CellItem => {
      const topics = open.find((each) => each.path === path)?.topics ?? []
      return { path, kind, name, model, owner, topics, text: '', line, file: '' }
    }
    const path = `${section}/${name}`
    const tool = section === 'robots' ? valueAt(value, ['gripper', 'model']) : undefined
    return [
      drawn(path, KINDS[section], modelOf(section, value), ''),
      ...(typeof tool === 'string' ? [drawn(`${path}/gripper`, 'tool', tool, path)] : []),
    ]
  })
  return [...beside, ...own]
}

function modelOf(section: Section, value: Dict<unknown>): string {
  const of = (key: string, usual: string) => {
    const written = lookup(value, key)
    return typeof written === 'string' ? written : usual
  }
  switch (section) {
    case 'fixtures':
    case 'parts':
      return of('shape', '')
    case 'cameras':
      return of('driver', 'sim')
    case 'robots':
      return of('model', '')
    case 'modules':
      return of('module', '')
    case 'equipment':
      return of('pins', of('driver', ''))
    case 'devices':
      return Object.keys(fieldsOf(lookup(value, 'positions'))).join(', ')
    case 'bonds':
      return of('kind', '')
    default:
      return `in ${of('parent', WORLD)}`
  }
}

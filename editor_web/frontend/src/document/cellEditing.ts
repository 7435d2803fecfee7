/** What can be edited of an item of a cell document: its fields, what a new one begins with, and the edits that change it. Pure. */
import type { CellDraft, CellEditsBody, CellItem, DraftItem } from '../api/types'
import { fieldsOf, lookup, type Dict } from './dict'
import { firstOfPath } from './path'
import { inWorld, NO_TURN, turnOf, vectorFrom, WORLD, type PlacedPose, type Vector } from './poses'

export type Section = DraftItem['section']
type Edit = CellEditsBody['edits'][number]

interface FieldBase {
  /** From the item inward. */
  readonly path: readonly string[]
  readonly label: string
  /** What holds where nothing is written; undefined where that is nothing. */
  readonly usual: unknown
}

export type Field =
  /** The choice of `none` writes nothing. */
  | (FieldBase & { readonly kind: 'choice'; readonly choices: readonly string[]; readonly none?: string })
  | (FieldBase & {
      readonly kind: 'numbers'
      readonly names: readonly string[]
      readonly unit: string
      readonly isAngle: boolean
      readonly minimum?: number
    })
  | (FieldBase & { readonly kind: 'colour' })
  | (FieldBase & { readonly kind: 'switch' })

/** What an item can be related to. */
export interface Surroundings {
  /** All that something may stand in. */
  readonly frames: readonly string[]
  readonly connectors: readonly string[]
  /** The folders of modules, as the document writes them. */
  readonly folders: readonly string[]
  /** The models of robots, and of tools. */
  readonly robots: readonly string[]
  readonly tools: readonly string[]
}

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
  { ...numbers('Metres per unit of the file', ['scale'], ['scale'], 'm', 1), minimum: 0 },
  { ...numbers('Pieces at most', ['decomposition', 'parts'], ['pieces'], '', 64), minimum: 1 },
  { ...numbers('Hollows are kept to', ['decomposition', 'error_m'], ['error'], 'm', 0.005), minimum: 0 },
]
const FIRST_SIZE_M = 0.1
const NO_TOOL = 'no tool'

/** The names of the lengths of a shape. */
export function sizeNames(shape: unknown): readonly string[] {
  return (typeof shape === 'string' ? lookup(SIZES, shape) : undefined) ?? XYZ
}

/** The fields of an item, whose value tells its shape. */
export function fieldsFor(section: Section, value: Dict<unknown>, around: Surroundings): readonly Field[] {
  const { frames, connectors, folders } = around
  const place = (label: string, path: readonly string[]): Field => ({ kind: 'choice', path, label, usual: WORLD, choices: frames })
  const position = (label: string, ...path: string[]): Field => numbers(label, path, XYZ, 'm', ORIGIN)
  const turn = (...path: string[]): Field => ({ ...numbers('Roll, pitch, yaw', path, ['r', 'p', 'y'], '°', ORIGIN), isAngle: true })
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
        ...(shape === 'mesh' ? MESH_FIELDS : [{ ...numbers('Size', ['size_m'], sizeNames(shape), 'm', undefined), minimum: 0 }]),
        ...(shape === 'tray' ? [{ ...numbers('Wall', ['wall_m'], ['wall'], 'm', 0.005), minimum: 0 }] : []),
        place('Stands in', ['at', 'frame']),
        position('Position', 'at', 'xyz'),
        turn('at', 'rpy'),
        ...(section === 'parts'
          ? ([
              { ...numbers('Mass', ['mass_kg'], ['mass'], 'kg', undefined), minimum: 0 },
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
        { ...numbers('Field of view', ['fov_rad'], ['angle'], '°', 1), isAngle: true, minimum: 0 },
        { ...numbers('Images', ['rate_hz'], ['rate'], '1/s', 10), minimum: 0 },
      ]
    case 'frames':
    case 'connectors':
      return [place('Stands in', ['parent']), position('Position', 'at', 'xyz'), turn('at', 'rpy')]
    case 'modules':
      return [
        { kind: 'choice', path: ['module'], label: 'Module', usual: '', choices: folders },
        { kind: 'choice', path: ['connector'], label: 'Docked to', usual: '', choices: connectors },
        { kind: 'switch', path: ['plugged'], label: 'Plugged when the cell is opened', usual: true },
      ]
  }
}

function numbers(
  label: string,
  path: readonly string[],
  names: readonly string[],
  unit: string,
  usual: unknown,
): Field & { kind: 'numbers' } {
  return { kind: 'numbers', path, label, names, unit, usual, isAngle: false }
}

export function keyOf(path: readonly string[]): string {
  return path.join('.')
}

/** What is at a path of a value; undefined where nothing is. */
export function valueAt(value: unknown, path: readonly string[]): unknown {
  return path.reduce((now: unknown, step) => lookup(fieldsOf(now), step), value)
}

/** The same value with another one at a path. */
export function withValue(value: Dict<unknown>, [first, ...rest]: readonly string[], to: unknown): Dict<unknown> {
  if (first === undefined) return value
  return { ...value, [first]: rest.length === 0 ? to : withValue(fieldsOf(lookup(value, first)), rest, to) }
}

/** Another shape needs other lengths: those that both have stay. */
export function withShape(value: Dict<unknown>, shape: string): Dict<unknown> {
  const before = numbersOf(lookup(value, 'size_m'))
  const size = sizeNames(shape).map((_, at) => before[at] ?? before[0] ?? FIRST_SIZE_M)
  return { ...value, shape, size_m: size }
}

export function numbersOf(value: unknown): readonly number[] {
  const all = Array.isArray(value) ? (value as unknown[]) : [value]
  return all.filter((each) => typeof each === 'number')
}

const DEGREE = Math.PI / 180

/** Numbers as the form shows them: degrees of radians. */
export function shownNumbers(field: Field & { readonly kind: 'numbers' }, value: unknown): readonly number[] {
  const written = numbersOf(value ?? field.usual)
  return field.names.map((_, at) => (written[at] ?? 0) / (field.isAngle ? DEGREE : 1))
}

/** What the document has for the numbers of the form; those that were not changed stay as they are written, to the last digit. */
export function writtenNumbers(field: Field & { readonly kind: 'numbers' }, value: unknown, shown: readonly number[]): unknown {
  const before = shownNumbers(field, value)
  const written = numbersOf(value ?? field.usual)
  const made = shown.map((each, at) => {
    const old = written[at]
    if (old !== undefined && each === before[at]) return old
    return Number((field.isAngle ? each * DEGREE : each).toFixed(6))
  })
  return Array.isArray(value ?? field.usual) || field.names.length > 1 || field.path[0] === 'size_m' ? made : made[0]
}

/** The edits that make the second value of the first one; a new name comes last, as the others are of the old one. */
export function editsBetween(
  { section, name, value }: Pick<DraftItem, 'section' | 'name' | 'value'>,
  next: Dict<unknown>,
  newName: string,
  fields: readonly Field[],
): readonly Edit[] {
  const changed = fields.filter(({ path }) => !isSame(valueAt(value, path), valueAt(next, path)))
  const edits = changed.map(({ path }): Edit => ({ edit: 'set_field', section, name, field: path, value: valueAt(next, path) ?? null }))
  return newName === name ? edits : [...edits, { edit: 'rename_item', section, name, new_name: newName }]
}

function isSame(a: unknown, b: unknown): boolean {
  return JSON.stringify(a ?? null) === JSON.stringify(b ?? null)
}

/** Why a name cannot be given; undefined where it can. The server knows which are taken. */
export function nameFault(name: string): string | undefined {
  return /^[a-z][a-z0-9_]{0,63}$/.test(name) ? undefined : 'Lower-case letters, digits and _'
}

export interface NewItem {
  readonly label: string
  readonly section: Section
  /** Its name begins with it. */
  readonly stem: string
  readonly value: (surroundings: Surroundings) => Dict<unknown>
  /** Why it cannot be added now. */
  readonly obstacle: (surroundings: Surroundings) => string | undefined
}

const NEVER = () => undefined
const onFloor = { at: { xyz: [0, 0, 0.05] } }

export const NEW_ITEMS: readonly NewItem[] = [
  {
    label: 'Robot',
    section: 'robots',
    stem: 'robot',
    value: ({ robots }) => ({ model: robots[0] ?? '', base: { xyz: [0, 0, 0] } }),
    obstacle: ({ robots }) => (robots.length === 0 ? 'no models of robots are installed' : undefined),
  },
  { label: 'Box', section: 'fixtures', stem: 'box', value: () => ({ shape: 'box', size_m: [0.1, 0.1, 0.1], ...onFloor }), obstacle: NEVER },
  {
    label: 'Cylinder',
    section: 'fixtures',
    stem: 'cylinder',
    value: () => ({ shape: 'cylinder', size_m: [0.1, 0.1], ...onFloor }),
    obstacle: NEVER,
  },
  {
    label: 'Tray',
    section: 'fixtures',
    stem: 'tray',
    value: () => ({ shape: 'tray', size_m: [0.3, 0.2, 0.05], at: { xyz: [0, 0, 0] } }),
    obstacle: NEVER,
  },
  {
    label: 'Part',
    section: 'parts',
    stem: 'part',
    value: () => ({ shape: 'box', size_m: [0.05, 0.05, 0.05], mass_kg: 0.1, at: { xyz: [0, 0, 0.025] } }),
    obstacle: NEVER,
  },
  { label: 'Frame', section: 'frames', stem: 'frame', value: () => ({ at: { xyz: [0, 0, 0] } }), obstacle: NEVER },
  { label: 'Camera', section: 'cameras', stem: 'camera', value: () => ({ at: [0, 0, 1.5], look_at: [0.3, 0, 0] }), obstacle: NEVER },
  { label: 'Connector', section: 'connectors', stem: 'connector', value: () => ({ at: { xyz: [0, 0, 0] } }), obstacle: NEVER },
  {
    label: 'Module',
    section: 'modules',
    stem: 'module',
    value: ({ folders, connectors }) => ({ module: folders[0] ?? '', connector: connectors[0] ?? '' }),
    obstacle: ({ folders, connectors }) =>
      folders.length === 0
        ? 'the project has no module.yaml'
        : connectors.length === 0
          ? 'every connector is taken: add one first'
          : undefined,
  },
]

/** A module has none of these. */
const OF_CELLS: ReadonlySet<Section> = new Set(['robots', 'connectors', 'modules'])

/** What can be added to a document of this kind. */
export function newItemsOf(kind: CellDraft['kind']): readonly NewItem[] {
  return kind === 'cell' ? NEW_ITEMS : NEW_ITEMS.filter(({ section }) => !OF_CELLS.has(section))
}

/** `box_1`, or the next number that is free. */
export function freeName(stem: string, taken: ReadonlySet<string>): string {
  for (let at = 1; ; at += 1) if (!taken.has(`${stem}_${at}`)) return `${stem}_${at}`
}

/** What the items of a draft can be related to; `folders` are those of all modules, beside the installed models. */
export function surroundingsOf(
  { items, frames, kind }: CellDraft,
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
  return { frames: kind === 'module' ? all : all.toSorted(byWorldFirst), connectors, folders, robots, tools }
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
    default:
      return `in ${of('parent', WORLD)}`
  }
}

/** A body or axes as the 3D view shows them before anything is applied. */
export interface ShownItem {
  readonly pose: PlacedPose
  readonly shape: 'box' | 'cylinder' | 'sphere' | undefined
  readonly size: readonly number[]
}

/** Where an item with this value is in the world; undefined where nobody can tell. */
export function shownItem(section: Section, value: Dict<unknown>, frames: CellDraft['frames']): ShownItem | undefined {
  const isCamera = section === 'cameras'
  const at = isCamera ? value : fieldsOf(lookup(value, placeKey(section)))
  const base = lookup(frames, frameOf(section, value))
  if (!base) return undefined
  const xyz: Vector = vectorFrom(lookup(at, isCamera ? 'at' : 'xyz')) ?? [0, 0, 0]
  const rpy = vectorFrom(lookup(at, 'rpy'))
  const place = { xyz: base.xyz, xyzw: base.xyzw }
  const pose = inWorld({ xyz, xyzw: rpy ? turnOf(rpy) : NO_TURN }, place)
  const shape = lookup(value, 'shape')
  const size = numbersOf(lookup(value, 'size_m'))
  if (size.length !== sizeNames(shape).length || size.some((each) => each <= 0)) return { pose, shape: undefined, size: [] }
  // The place of a tray is the middle of its underside.
  if (shape === 'tray') return { pose: inWorld({ xyz: [0, 0, (size[2] ?? 0) / 2], xyzw: NO_TURN }, pose), shape: 'box', size }
  return { pose, shape: shape === 'box' || shape === 'cylinder' || shape === 'sphere' ? shape : undefined, size }
}

/** The field in which an item has its place. */
export function placeKey(section: Section): 'at' | 'base' {
  return section === 'robots' ? 'base' : 'at'
}

/** The name of what an item stands in. */
export function frameOf(section: Section, value: Dict<unknown>): string {
  const paths: Readonly<Record<Section, readonly string[]>> = {
    robots: ['base', 'frame'],
    fixtures: ['at', 'frame'],
    parts: ['at', 'frame'],
    cameras: ['frame'],
    frames: ['parent'],
    connectors: ['parent'],
    modules: ['connector'],
  }
  const written = valueAt(value, paths[section])
  // A module that is plugged later may name no connector yet.
  return typeof written === 'string' ? written : section === 'modules' ? '' : WORLD
}

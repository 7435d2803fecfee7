/** The fields of devices, equipment and bonds of a cell, what is added to a device, and where its axes end. Pure. */
import type { CellDraft } from '../api/types'
import { numbersAt, numbersOf, valueAt, withValue, wordsOf, type Field, type FieldGroup, type Surroundings } from './cellFields'
import { fieldsOf, lookup, type Dict } from './dict'
import { inWorld, NO_TURN, normalised, scaled, vectorFrom, type PlacedPose, type Quaternion } from './poses'

const XYZ = ['x', 'y', 'z'] as const
const BOND_KINDS = ['clip', 'solder', 'glue'] as const
const NO_PINS = 'none: simulated'
/** `30 s`, `500 ms`, or seconds. */
export const DURATION = /^\d+(\.\d+)?( ?(ms|s|min|h))?$/
const DURATION_HINT = 'such as `500 ms` or `2 s`'
const NAME = /^[a-z][a-z0-9_]{0,63}$/
const NAME_HINT = 'Lower-case letters, digits and _'
const EQUIPMENT_PORT = 7391

function choice(label: string, path: readonly string[], choices: readonly string[], usual: unknown = ''): Field {
  return { kind: 'choice', path, label, usual, choices }
}

function amount(label: string, path: readonly string[], name: string, unit: string, usual?: number): Field {
  return { ...numbersAt(label, path, [name], unit, usual), minimum: 0 }
}

/** A number that may be missing: `absent` says what that means. */
function limit(label: string, path: readonly string[], unit: string, absent: string): Field & { readonly kind: 'numbers' } {
  return { ...numbersAt(label, path, ['limit'], unit, undefined), absent }
}

function text(label: string, path: readonly string[], hint = '', usual: unknown = ''): Field & { readonly kind: 'text' } {
  return { kind: 'text', path, label, hint, usual }
}

function output(label: string, path: readonly string[]): Field {
  return { ...text(label, path, NAME_HINT), pattern: NAME }
}

function duration(label: string, path: readonly string[], usual: unknown): Field {
  return { ...text(label, path, DURATION_HINT, usual), pattern: DURATION }
}

export function bondFields({ parts, fixtures }: Surroundings): readonly Field[] {
  return [
    choice('Kind', ['kind'], BOND_KINDS),
    choice('Part', ['part'], parts),
    choice('Joined to', ['to'], [...parts, ...fixtures]),
    numbersAt('Place in the part', ['at_m'], XYZ, 'm', [0, 0, 0]),
    { ...limit('Breaks at', ['force_n'], 'N', 'holds any force'), minimum: 0 },
    { ...limit('Breaks at a torque', ['torque_nm'], 'Nm', 'holds any torque'), minimum: 0 },
    { kind: 'switch', path: ['point'], label: 'A point, which carries no torque', usual: false },
    { ...limit('A blade parts it', ['cut_n'], 'N', 'no blade does'), minimum: 0 },
    numbersAt('Deviation', ['jitter'], ['share'], '', 0),
  ]
}

export function equipmentFields(value: Dict<unknown>): readonly Field[] {
  const kind = valueAt(value, ['driver', 'kind'])
  return [
    choice('Driver', ['driver', 'kind'], ['sim', 'equipment'], 'sim'),
    ...(kind === 'equipment'
      ? [
          text('Host', ['driver', 'host'], 'Of the program that serves it'),
          numbersAt('Port', ['driver', 'port'], ['port'], '', EQUIPMENT_PORT),
        ]
      : []),
    text('Pins', ['pins'], 'Its equipment document, relative to this one'),
  ]
}

/** Another driver has other options; `sim` is what holds where nothing is written. */
export function withDriver(value: Dict<unknown>, kind: unknown): Dict<unknown> {
  const driver = kind === 'sim' ? undefined : { kind, ...(kind === 'equipment' && { host: '127.0.0.1', port: EQUIPMENT_PORT }) }
  return { ...value, driver }
}

/** The fields of a device: its own, and a group for each axis, belt, sensor and position. */
export function deviceGroups(value: Dict<unknown>, around: Surroundings): readonly FieldGroup[] {
  const entries = (group: string) => Object.entries(fieldsOf(lookup(value, group))).map(([name, each]) => [name, fieldsOf(each)] as const)
  const sensors = entries('sensors').map(([name]) => name)
  const { fixtures, equipment } = around
  const group = (key: string, title: string, fieldsAt: (path: readonly string[], each: Dict<unknown>) => readonly Field[]): FieldGroup[] =>
    entries(key).map(([name, each]) => ({ title: `${title} ${name}`, entry: [key, name], fields: fieldsAt([key, name], each) }))
  return [
    {
      title: '',
      fields: [
        text('Description', ['description']),
        ...(equipment.length > 0 || lookup(value, 'equipment') !== undefined
          ? [{ ...choice('Pins of', ['equipment'], [NO_PINS, ...equipment], NO_PINS), none: NO_PINS } as Field]
          : []),
      ],
    },
    ...group('axes', 'Axis', (path, axis) => axisFields(path, axis, fixtures)),
    ...group('belts', 'Belt', (path) => [
      choice('Surface of', [...path, 'body'], fixtures),
      numbersAt('Runs along', [...path, 'along'], XYZ, '', [0, 0, 0]),
      amount('Speed', [...path, 'speed_m_s'], 'v', 'm/s'),
      amount('Acceleration', [...path, 'acceleration_m_s2'], 'a', 'm/s²', 2),
      amount('Friction', [...path, 'friction'], 'µ', '', 0.7),
      output('Output', [...path, 'output']),
      output('Output back', [...path, 'output_back']),
    ]),
    ...group('sensors', 'Sensor', (path, sensor) => sensorFields(path, sensor, value, fixtures)),
    ...group('positions', 'Position', (path) => [
      { kind: 'steps', path: [...path, 'steps'], label: 'Steps', usual: [], outputs: outputsOf(value), sensors },
      { kind: 'levels', path: [...path, 'sensors'], label: 'Told by', usual: {}, choices: sensors, isOpen: false },
      duration('Time', [...path, 'time'], ''),
      duration('Stable for', [...path, 'stable'], '0'),
    ]),
    {
      title: 'Interlocks',
      fields: [
        {
          kind: 'interlocks',
          path: ['interlocks'],
          label: 'Interlocks',
          usual: [],
          own: entries('positions').map(([name]) => name),
          others: around.positions,
        },
      ],
    },
  ]
}

function axisFields(path: readonly string[], axis: Dict<unknown>, fixtures: readonly string[]): readonly Field[] {
  const turns = lookup(axis, 'joint') === 'hinge'
  const at = (key: string) => [...path, key]
  return [
    choice('Joint', at('joint'), ['slide', 'hinge']),
    choice('Moves', at('body'), fixtures),
    numbersAt(turns ? 'Turns about' : 'Slides along', at('along'), XYZ, '', [0, 0, 0]),
    ...(turns
      ? [
          { ...numbersAt('Stroke', at('stroke_rad'), ['angle'], '°', undefined), isAngle: true, minimum: 0 },
          amount('Torque at rest', at('torque_nm'), 'M', 'Nm'),
          { ...numbersAt('Speed', at('speed_rad_s'), ['v'], '°/s', undefined), isAngle: true, minimum: 0 },
        ]
      : [
          amount('Stroke', at('stroke_m'), 's', 'm'),
          amount('Force at rest', at('force_n'), 'F', 'N'),
          amount('Speed', at('speed_m_s'), 'v', 'm/s'),
        ]),
    output('Output', at('output')),
    output('Output back', at('output_back')),
    amount('Moved mass', at('mass_kg'), 'm', 'kg', 0.5),
    amount('Friction', at('friction'), 'µ', '', 0.5),
    { kind: 'names', path: at('against'), label: 'Presses against', usual: [], choices: fixtures },
    { kind: 'names', path: at('cuts'), label: 'Cuts', usual: [], choices: BOND_KINDS },
    { kind: 'switch', path: at('self_holding'), label: 'Holds without air', usual: false },
  ]
}

function sensorFields(
  path: readonly string[],
  sensor: Dict<unknown>,
  device: Dict<unknown>,
  fixtures: readonly string[],
): readonly Field[] {
  if (lookup(sensor, 'air') === true) return [{ kind: 'switch', path: [...path, 'air'], label: 'On while there is air', usual: false }]
  if (lookup(sensor, 'beam') !== undefined)
    return [
      choice('Beam in the frame of', [...path, 'beam', 'body'], fixtures),
      numbersAt('From', [...path, 'beam', 'start_m'], XYZ, 'm', [0, 0, 0]),
      numbersAt('To', [...path, 'beam', 'end_m'], XYZ, 'm', [0, 0, 0]),
    ]
  const axes = fieldsOf(lookup(device, 'axes'))
  const isAngle = valueAt(axes, [wordsOf(lookup(sensor, 'axis')), 'joint']) === 'hinge'
  const unit = isAngle ? '°' : 'm'
  return [
    choice('At the axis', [...path, 'axis'], Object.keys(axes)),
    { ...limit('On from', [...path, 'at_least'], unit, 'its start'), isAngle },
    { ...limit('On up to', [...path, 'at_most'], unit, 'its end'), isAngle },
  ]
}

/** The outputs of a device: those that its steps set, and those of its axes and belts. */
export function outputsOf(device: Dict<unknown>): readonly string[] {
  const inner = (key: string) => Object.values(fieldsOf(lookup(device, key))).map(fieldsOf)
  const moving = [...inner('axes'), ...inner('belts')].flatMap((each) => [lookup(each, 'output'), lookup(each, 'output_back')])
  const set = inner('positions').flatMap((each) =>
    listOf(lookup(each, 'steps')).flatMap((step) => Object.keys(fieldsOf(lookup(step, 'set')))),
  )
  return [...new Set([...moving, ...set])].filter((each) => typeof each === 'string' && each !== '') as string[]
}

/** The mappings of a list. */
export function listOf(value: unknown): readonly Dict<unknown>[] {
  return Array.isArray(value) ? value.map(fieldsOf) : []
}

/** An axis with the other joint has its stroke, force and speed in other units. */
export function withJoint(device: Dict<unknown>, axis: string, joint: unknown): Dict<unknown> {
  const old = fieldsOf(valueAt(device, ['axes', axis]))
  const kept = Object.fromEntries(Object.entries(old).filter(([key]) => !/^(joint|stroke_|force_|torque_|speed_)/.test(key)))
  const made = joint === 'hinge' ? { stroke_rad: 1.570796, torque_nm: 5, speed_rad_s: 1 } : { stroke_m: 0.05, force_n: 50, speed_m_s: 0.05 }
  return withValue(device, ['axes', axis], { joint, ...kept, ...made })
}

/** Something that a device gets. */
export interface NewEntry {
  readonly label: string
  readonly group: 'axes' | 'belts' | 'sensors' | 'positions'
  readonly stem: string
  readonly value: (device: Dict<unknown>, around: Surroundings) => Dict<unknown>
  readonly obstacle: (device: Dict<unknown>, around: Surroundings) => string | undefined
}

const NEVER = () => undefined
const needsFixture = (_: Dict<unknown>, { fixtures }: Surroundings) => (fixtures.length === 0 ? 'add a fixture that it moves' : undefined)
const axesOf = (device: Dict<unknown>) => Object.keys(fieldsOf(lookup(device, 'axes')))
const moved = (device: Dict<unknown>, { fixtures }: Surroundings) => {
  const used = new Set(Object.values(fieldsOf(lookup(device, 'axes'))).map((each) => lookup(fieldsOf(each), 'body')))
  return fixtures.find((each) => !used.has(each)) ?? fixtures[0] ?? ''
}
const firstOutput = (device: Dict<unknown>) => outputsOf(device)[0] ?? 'output'

export const NEW_ENTRIES: readonly NewEntry[] = [
  {
    label: 'Axis that slides',
    group: 'axes',
    stem: 'axis',
    value: (device, around) => ({
      joint: 'slide',
      body: moved(device, around),
      along: [1, 0, 0],
      stroke_m: 0.05,
      force_n: 50,
      speed_m_s: 0.05,
      output: firstOutput(device),
    }),
    obstacle: needsFixture,
  },
  {
    label: 'Axis that turns',
    group: 'axes',
    stem: 'axis',
    value: (device, around) => ({
      joint: 'hinge',
      body: moved(device, around),
      along: [0, 0, 1],
      stroke_rad: 1.570796,
      torque_nm: 5,
      speed_rad_s: 1,
      output: firstOutput(device),
    }),
    obstacle: needsFixture,
  },
  {
    label: 'Belt',
    group: 'belts',
    stem: 'belt',
    value: (device, around) => ({ body: moved(device, around), along: [1, 0, 0], speed_m_s: 0.1, output: firstOutput(device) }),
    obstacle: needsFixture,
  },
  {
    label: 'Sensor at an axis',
    group: 'sensors',
    stem: 'sensor',
    value: (device) => ({ axis: axesOf(device)[0] ?? '', at_most: 0.002 }),
    obstacle: (device) => (axesOf(device).length === 0 ? 'add an axis first' : undefined),
  },
  {
    label: 'Light barrier',
    group: 'sensors',
    stem: 'barrier',
    value: (_, { fixtures }) => ({ beam: { body: fixtures[0] ?? '', start_m: [0, -0.1, 0], end_m: [0, 0.1, 0] } }),
    obstacle: needsFixture,
  },
  { label: 'Pressure switch', group: 'sensors', stem: 'air', value: () => ({ air: true }), obstacle: NEVER },
  {
    label: 'Position',
    group: 'positions',
    stem: 'position',
    value: (device) => ({ steps: [{ set: { [firstOutput(device)]: true } }], time: '1 s' }),
    obstacle: NEVER,
  },
]

/** A device without one of its entries. */
export function withoutEntry(device: Dict<unknown>, group: string, name: string): Dict<unknown> {
  const kept = Object.fromEntries(Object.entries(fieldsOf(lookup(device, group))).filter(([key]) => key !== name))
  return { ...device, [group]: kept }
}

/** A mark in the 3D view: the body of an axis at the end of its stroke, where it is a fixture of the document. */
export interface AxisEnd {
  readonly pose: PlacedPose
  readonly fixture: Dict<unknown> | undefined
}

/** Where an axis of a device ends; the first one where none is named. */
export function axisEnd(device: Dict<unknown>, axis: string, { frames, items }: Pick<CellDraft, 'frames' | 'items'>): AxisEnd | undefined {
  const name = axesOf(device).includes(axis) ? axis : axesOf(device)[0]
  const spec = fieldsOf(valueAt(device, ['axes', name ?? '']))
  const body = wordsOf(lookup(spec, 'body'))
  const base = lookup(frames, body)
  const along = vectorFrom(lookup(spec, 'along'))
  if (!base || !along) return undefined
  const length = Math.hypot(...along)
  if (length === 0) return undefined
  const direction = scaled(along, 1 / length)
  const [metres, radians] = [numbersOf(lookup(spec, 'stroke_m'))[0] ?? 0, numbersOf(lookup(spec, 'stroke_rad'))[0] ?? 0]
  const turns = lookup(spec, 'joint') === 'hinge'
  const half = scaled(direction, Math.sin(radians / 2))
  const turn: Quaternion = turns ? normalised([half[0], half[1], half[2], Math.cos(radians / 2)]) : NO_TURN
  const pose = inWorld({ xyz: turns ? [0, 0, 0] : scaled(direction, metres), xyzw: turn }, base)
  return { pose, fixture: items.find((each) => each.section === 'fixtures' && each.name === body)?.value }
}

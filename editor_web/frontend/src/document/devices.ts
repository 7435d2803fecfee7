/** The devices with a driver: which are real now, and which the world simulates. */
import type { DeviceDetails, DeviceLink, DeviceState, DrivenDeviceChoice, SessionBody } from '../api/types'
import { lookup, type Dict } from './dict'
import { requestFields } from './requestForm'
import type { Status } from './runState'
import { rangeText } from './schema'

/** The devices that are real; empty where everything is simulated. */
export function realDevices(session: SessionBody | undefined): readonly DrivenDeviceChoice[] {
  return (session?.devices ?? []).filter((each) => !each.simulated)
}

/** What stands beside the name of the cell; empty for a cell that no driver belongs to. */
export function devicesWords(session: SessionBody | undefined): string {
  const devices = session?.devices ?? []
  if (devices.length === 0) return ''
  const real = realDevices(session)
  return real.length === 0 ? 'All simulated' : `Real: ${real.map((each) => each.device).join(', ')}`
}

const MODES: Readonly<Record<DeviceState['mode'], readonly [words: string, look: Status]>> = {
  reading: ['read only, not enabled', 'locked'],
  enabled: ['enabled', 'done'],
  stopped: ['stopped', 'stopped'],
  fault: ['fault', 'failed'],
  lost: ['connection lost', 'warning'],
}

/** What a real device may do, in words and with its look. */
export function deviceMode({ mode }: Pick<DeviceState, 'mode'>): { readonly words: string; readonly look: Status } {
  const [words, look] = MODES[mode]
  return { words, look }
}

/** How fresh the readings are: `50 per second, longest gap 0.03 s`. */
export function linkWords({ readings_hz, longest_gap_s }: DeviceLink): string {
  return `${Math.round(readings_hz)} readings per second, longest gap ${longest_gap_s.toFixed(2)} s`
}

/** Why a device cannot be enabled from this page; undefined where it can. */
export function enableObstacle(state: Pick<DeviceState, 'connected'> | undefined, mayOperate: boolean): string | undefined {
  if (!mayOperate) return 'only who is logged in as operator enables devices'
  if (!state) return 'nothing is known of the device yet'
  return state.connected ? undefined : 'it does not answer: connect the cell again first'
}

/** One option of a driver as it is set, with what may be set. */
export interface DriverOption {
  readonly name: string
  readonly value: string
  readonly unit: string
  /** Empty where the document has to give a value. */
  readonly preset: string
  readonly isSet: boolean
  readonly description: string
  readonly range: string
}

// The end of a name is its unit, as in the whole cell document.
const UNITS: Readonly<Record<string, string>> = {
  s: 's',
  m: 'm',
  mm: 'mm',
  rad: 'rad',
  deg: '°',
  kg: 'kg',
  hz: 'Hz',
  ma: 'mA',
  n: 'N',
  ticks: 'ticks',
}

/** All options of a driver by its schema, in the order of the schema. */
export function driverOptions({ options, schema }: Pick<DeviceDetails, 'options' | 'schema'>): readonly DriverOption[] {
  return requestFields(schema)
    .filter(({ name }) => name !== 'kind')
    .map((field) => {
      const given = lookup(options, field.name)
      const preset = field.required ? '' : textOf(field.initial)
      return {
        name: field.name,
        value: given === undefined ? preset : textOf(given),
        unit: field.unit || UNITS[field.name.slice(field.name.lastIndexOf('_') + 1)] || '',
        preset,
        isSet: given !== undefined,
        description: chosenDescription(schema, field.name, given) ?? field.description,
        range: field.choices.length > 0 ? field.choices.join(', ') : rangeText(field),
      }
    })
}

/** Of an option that is one of several shapes: what the shape is that was chosen, which its `kind` tells. */
function chosenDescription(schema: Dict<unknown>, option: string, given: unknown): string | undefined {
  const kind = isDict(given) ? given['kind'] : undefined
  if (kind === undefined) return undefined
  const shapes = Object.values(isDict(schema['$defs']) ? schema['$defs'] : {}).filter(isDict)
  const root = shapes.find((shape) => isDict(shape['properties']) && option in shape['properties'])
  const property = isDict(root?.['properties']) ? lookup(root['properties'], option) : undefined
  const named = JSON.stringify(property)
  const chosen = shapes.find((shape) => {
    const of = isDict(shape['properties']) && isDict(shape['properties']['kind']) ? shape['properties']['kind']['enum'] : undefined
    return Array.isArray(of) && of.includes(kind) && typeof shape['title'] === 'string' && named.includes(`/${shape['title']}"`)
  })
  return typeof chosen?.['description'] === 'string' ? chosen['description'] : undefined
}

function isDict(value: unknown): value is Dict<unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value)
}

/** A value as text; the parts of a composed one by their names. */
function textOf(value: unknown): string {
  if (typeof value === 'string') return value
  if (!isDict(value)) return JSON.stringify(value)
  return Object.entries(value)
    .map(([name, part]) => `${name}: ${textOf(part)}`)
    .join(', ')
}

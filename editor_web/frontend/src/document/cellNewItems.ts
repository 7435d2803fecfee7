/** What can be added to a document of a cell, and what it begins with. Pure. */
import type { CellDraft } from '../api/types'
import { withDriver } from './cellDevices'
import type { Section, Surroundings } from './cellFields'
import type { Dict } from './dict'

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
  {
    label: 'Device',
    section: 'devices',
    stem: 'device',
    value: () => ({
      positions: {
        on: { steps: [{ set: { output: true } }], time: '1 s' },
        off: { steps: [{ set: { output: false } }], time: '1 s' },
      },
    }),
    obstacle: NEVER,
  },
  {
    label: 'Equipment',
    section: 'equipment',
    stem: 'equipment',
    value: () => withDriver({}, 'equipment'),
    obstacle: NEVER,
  },
  {
    label: 'Bond',
    section: 'bonds',
    stem: 'bond',
    value: ({ parts, fixtures }) => ({ kind: 'glue', part: parts[0] ?? '', to: [...parts.slice(1), ...fixtures][0] ?? '' }),
    obstacle: ({ parts, fixtures }) =>
      parts.length === 0
        ? 'a bond joins a part: add one first'
        : parts.length + fixtures.length < 2
          ? 'there is nothing to join'
          : undefined,
  },
]

/** A module has none of these. */
const OF_CELLS: ReadonlySet<Section> = new Set(['robots', 'connectors', 'modules', 'equipment'])

/** What can be added to a document of this kind. */
export function newItemsOf(kind: CellDraft['kind']): readonly NewItem[] {
  return kind === 'cell' ? NEW_ITEMS : NEW_ITEMS.filter(({ section }) => !OF_CELLS.has(section))
}

/** `box_1`, or the next number that is free. */
export function freeName(stem: string, taken: ReadonlySet<string>): string {
  for (let at = 1; ; at += 1) if (!taken.has(`${stem}_${at}`)) return `${stem}_${at}`
}

/** Which keys of the keyboard and of a gamepad are buttons, kept in the browser; and which are down. */
import { pageStore } from '../../api/pageStore'

export interface KeyButton {
  /** `code` of the key, `Space`. */
  readonly code: string
  /** The button on the bus, `play_pause`. */
  readonly button: string
}

const KEPT = 'flexcell.teach.keys'
const BUTTON = /^[a-z0-9_]{1,40}$/

const FIRST_KEYS: readonly KeyButton[] = [
  { code: 'ArrowLeft', button: 'previous' },
  { code: 'Space', button: 'play_pause' },
  { code: 'ArrowRight', button: 'next' },
]

/** The buttons of the standard gamepad by their numbers. */
const GAMEPAD_BUTTONS = [
  'south',
  'east',
  'west',
  'north',
  'left_1',
  'right_1',
  'left_2',
  'right_2',
  'select',
  'start',
  'left_stick',
  'right_stick',
  'up',
  'down',
  'left',
  'right',
  'home',
] as const

/** The buttons that are down on any of these gamepads. */
export function padButtons(pads: readonly (Gamepad | null)[]): ReadonlySet<string> {
  const down = new Set<string>()
  for (const pad of pads) {
    pad?.buttons.forEach((button, at) => button.pressed && down.add(GAMEPAD_BUTTONS[at] ?? `button_${at}`))
  }
  return down
}

export function buttonFault(button: string): string {
  return BUTTON.test(button) ? '' : 'Lower-case letters, digits and _'
}

interface ButtonStore {
  readonly isOn: boolean
  readonly keys: readonly KeyButton[]
  /** Names with their source, `keyboard/next`. */
  readonly pressed: ReadonlySet<string>
}

export const useButtonMap = pageStore<ButtonStore>(() => ({ isOn: false, keys: keptKeys(), pressed: new Set() }))

function keptKeys(): readonly KeyButton[] {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(KEPT) ?? 'null')
    if (!Array.isArray(kept)) return FIRST_KEYS
    return kept.filter(isKey)
  } catch {
    // What somebody else has written there is no reason not to start.
    return FIRST_KEYS
  }
}

export function keepKeys(keys: readonly KeyButton[]): void {
  useButtonMap.setState({ keys })
  localStorage.setItem(KEPT, JSON.stringify(keys))
}

function isKey(kept: unknown): kept is KeyButton {
  if (typeof kept !== 'object' || kept === null) return false
  const { code, button } = kept as Partial<Record<keyof KeyButton, unknown>>
  return typeof code === 'string' && typeof button === 'string' && buttonFault(button) === ''
}

/** A key with what is held down beside it. Pure. */

export interface Chord {
  readonly key: string
  readonly ctrl?: boolean
  readonly shift?: boolean
  readonly alt?: boolean
}

export interface Press {
  readonly key: string
  readonly ctrlKey: boolean
  readonly metaKey: boolean
  readonly altKey: boolean
  readonly shiftKey: boolean
}

const MODIFIERS: ReadonlySet<string> = new Set([
  'Control',
  'Shift',
  'Alt',
  'Meta',
  'AltGraph',
  'CapsLock',
  'Dead',
  'Process',
  'Unidentified',
])

function isLetter(key: string): boolean {
  return /^[a-zA-Z]$/.test(key)
}

/** Is this press the chord? Letters do not ask for Shift unless the chord does; Command counts as Ctrl. */
export function isChord(press: Press, chord: Chord): boolean {
  const ctrl = press.ctrlKey || press.metaKey
  if (ctrl !== (chord.ctrl ?? false) || press.altKey !== (chord.alt ?? false)) return false
  if (isLetter(chord.key) && press.shiftKey !== (chord.shift ?? false)) return false
  if (!isLetter(chord.key) && chord.shift && !press.shiftKey) return false
  return press.key.toLowerCase() === chord.key.toLowerCase()
}

/** The chord that a press is; undefined while only Ctrl, Shift or Alt are held. */
export function chordOf(press: Press): Chord | undefined {
  const { key } = press
  if (MODIFIERS.has(key)) return undefined
  // Of a sign such as `?` the layout of the keyboard says whether it needs Shift.
  const hasShift = press.shiftKey && (isLetter(key) || key.length > 1)
  return {
    key: isLetter(key) ? key.toLowerCase() : key,
    ...(press.ctrlKey || press.metaKey ? { ctrl: true } : {}),
    ...(hasShift ? { shift: true } : {}),
    ...(press.altKey ? { alt: true } : {}),
  }
}

export function isSameChord(one: Chord, other: Chord): boolean {
  return chordText(one) === chordText(other)
}

/** A character by itself: what people who speak to their computer type by accident. */
export function isCharacter(press: Press): boolean {
  return press.key.length === 1 && !press.ctrlKey && !press.metaKey && !press.altKey
}

const NAMES: Record<string, string> = {
  ArrowLeft: '←',
  ArrowRight: '→',
  ArrowUp: '↑',
  ArrowDown: '↓',
  Escape: 'Esc',
  Delete: 'Del',
  ' ': 'Space',
}

/** `Ctrl+Shift+Z`. */
export function chordText(chord: Chord): string {
  const key = NAMES[chord.key] ?? (chord.key.length === 1 ? chord.key.toUpperCase() : chord.key)
  return [chord.ctrl && 'Ctrl', chord.alt && 'Alt', chord.shift && 'Shift', key].filter(Boolean).join('+')
}

/** `Control+Shift+Z`, as screen readers are told. */
export function chordForReaders(chord: Chord): string {
  const key = chord.key === ' ' ? 'Space' : chord.key.length === 1 ? chord.key.toUpperCase() : chord.key
  return [chord.ctrl && 'Control', chord.alt && 'Alt', chord.shift && 'Shift', key].filter(Boolean).join('+')
}

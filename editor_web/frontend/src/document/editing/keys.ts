/** The keys of the editor: one list for the handler, the command palette and the sheet. Pure. */

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

/** Is this press the chord? Letters do not ask for Shift unless the chord does; Command counts as Ctrl. */
export function isChord(press: Press, chord: Chord): boolean {
  const ctrl = press.ctrlKey || press.metaKey
  if (ctrl !== (chord.ctrl ?? false) || press.altKey !== (chord.alt ?? false)) return false
  const isLetter = /^[a-zA-Z]$/.test(chord.key)
  if (isLetter && press.shiftKey !== (chord.shift ?? false)) return false
  if (!isLetter && chord.shift && !press.shiftKey) return false
  return press.key.toLowerCase() === chord.key.toLowerCase()
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

/** The keys of the run view: one list for the handler and for the sheet. Pure. */

export const SHORTCUTS = [
  { key: 'p', id: 'pause', words: 'Pause, or resume a paused run' },
  { key: 'i', id: 'into', words: 'Step into the next node' },
  { key: 'o', id: 'over', words: 'Step over the contents of the next node' },
  { key: 'u', id: 'out', words: 'Step out of the container' },
  { key: 'z', id: 'back', words: 'Step back: undo the last started node' },
  { key: 'b', id: 'break', words: 'Breakpoint before the selected node, on or off' },
  { key: 'l', id: 'lock', words: 'Lock or unlock the selected node' },
  { key: 'r', id: 'repeat', words: 'Run the selected node again' },
  { key: 'f', id: 'force', words: 'Go to the outcomes that can be forced' },
  { key: 'a', id: 'answer', words: 'Go to the question of the run' },
  { key: 'g', id: 'waiting', words: 'Go to a node that waits' },
  { key: 'S', id: 'stop', words: 'Stop the run (Shift + S)' },
  { key: '?', id: 'sheet', words: 'This list' },
] as const

export type ShortcutId = (typeof SHORTCUTS)[number]['id']

interface Press {
  readonly key: string
  readonly ctrlKey: boolean
  readonly metaKey: boolean
  readonly altKey: boolean
}

/** The shortcut that a key press means, if any. */
export function shortcutOf(press: Press): ShortcutId | undefined {
  if (press.ctrlKey || press.metaKey || press.altKey) return undefined
  return SHORTCUTS.find((each) => each.key === press.key)?.id
}

/** Every command of the page that a key can have, with the keys it has at first: the one table of them. Pure. */
import { isSameChord, type Chord } from './chord'

/** Where its keys count: on every page, on that of a run, or in the editor. */
export type CommandPlace = 'page' | 'run' | 'editor'

interface Row {
  readonly id: string
  readonly place: CommandPlace
  /** The heading it is listed under. */
  readonly part: string
  readonly words: string
  readonly chords: readonly Chord[]
}

/** `Ctrl+Shift+z` as it is written here. */
function keys(...written: readonly string[]): readonly Chord[] {
  return written.map((each) => {
    const parts = each.split('+')
    const key = each.endsWith('+') ? '+' : (parts.at(-1) ?? '')
    return {
      key,
      ...(parts.includes('Ctrl') && { ctrl: true }),
      ...(parts.includes('Shift') && { shift: true }),
      ...(parts.includes('Alt') && { alt: true }),
    }
  })
}

function table<const Place extends CommandPlace, const Id extends string>(
  place: Place,
  part: string,
  rows: readonly (readonly [Id, string, ...string[]])[],
): readonly (Row & { readonly id: Id; readonly place: Place })[] {
  return rows.map(([id, words, ...written]) => ({ id, place, part, words, chords: keys(...written) }))
}

const PAGE = table('page', 'Every page', [
  ['search', 'Search: every command, behavior, state, entry and run', 'Ctrl+k'],
  ['sheet', 'All keys', '?'],
])
const RUN = table('run', 'Run', [
  ['pause', 'Pause, or resume a paused run', 'p'],
  ['into', 'Step into the next node', 'i'],
  ['over', 'Step over the contents of the next node', 'o'],
  ['out', 'Step out of the container', 'u'],
  ['back', 'Step back: undo the last started node', 'z'],
  ['break', 'Breakpoint before the selected node, on or off', 'b'],
  ['condition', 'Go to the condition of the breakpoint at the selected node', 'Shift+b'],
  ['lock', 'Lock or unlock the selected node', 'l'],
  ['repeat', 'Run the selected node again', 'r'],
  ['force', 'Go to the outcomes that can be forced', 'f'],
  ['answer', 'Go to the question of the run', 'a'],
  ['waiting', 'Go to a node that waits', 'g'],
  ['stop', 'Stop the run', 'Shift+s'],
])
const DOCUMENT = table('editor', 'Document', [
  ['save', 'Save', 'Ctrl+s'],
  ['run', 'Save, check, and go to the run page', 'Ctrl+Enter'],
  ['run-from', 'Run from here…'],
  ['run-to', 'Run to here…'],
  ['undo', 'Undo', 'Ctrl+z'],
  ['redo', 'Redo', 'Ctrl+Shift+z', 'Ctrl+y'],
  ['discard', 'Go back to the file as saved'],
  ['text', 'Show or hide the text', 'y'],
  ['settings', 'Parameters, userdata and outcomes of the behavior', ','],
  ['versions', 'Versions: compare and restore', 'h'],
  ['svg', 'Export as SVG'],
  ['png', 'Export as PNG'],
  ['pdf', 'Export as PDF'],
  ['problem', 'Go to the next problem', 'F8'],
])
const BUILD = table('editor', 'Build', [
  ['add', 'Add a state or container', 'a', 'Insert'],
  ['connect', 'Connect an outcome of the selected node', 'c'],
  ['auto', 'Add obvious transitions', 'w'],
  ['initial', 'Let the machine begin with the selected node', 'i'],
  ['rename', 'Rename', 'F2'],
  ['replace', 'Replace what the selected nodes are: another state, behavior or container', 'Shift+r'],
  ['disable', 'Disable the selected nodes, or enable them again', 'x'],
  ['note', 'Add a note to the selected node, or to the container on the canvas', 'n'],
  ['free-note', 'Add a free note to the canvas', 'Shift+n'],
  ['remove', 'Delete', 'Delete', 'Backspace'],
  ['duplicate', 'Duplicate', 'Ctrl+d'],
  ['copy', 'Copy', 'Ctrl+c'],
  ['cut', 'Cut', 'Ctrl+x'],
  ['paste', 'Paste', 'Ctrl+v'],
  ['group', 'Group into a machine', 'Ctrl+g'],
  ['group-concurrency', 'Group to run side by side'],
  ['ungroup', 'Ungroup', 'Ctrl+Shift+g'],
])
const ARRANGE = table('editor', 'Arrange', [
  ['layout', 'Auto-layout', 'l'],
  ['layout-selected', 'Auto-layout of the selected nodes', 'Shift+l'],
  ['align-left', 'Align left'],
  ['align-right', 'Align right'],
  ['align-bottom', 'Align bottom'],
  ['align-top', 'Align top'],
  ['align-row', 'Put in a row'],
  ['align-column', 'Put in a column'],
  ['distribute-across', 'Distribute horizontally'],
  ['distribute-down', 'Distribute vertically'],
  ['left', 'Move left, or before its sibling', 'Alt+ArrowLeft'],
  ['right', 'Move right, or behind its sibling', 'Alt+ArrowRight'],
  ['up', 'Move up', 'Alt+ArrowUp'],
  ['down', 'Move down', 'Alt+ArrowDown'],
])
const MOVE = table('editor', 'Move around', [
  ['all', 'Select everything here', 'Ctrl+a'],
  ['alike', 'Select every node that runs the same'],
  ['source', 'Show the Python source of what the selected node runs', 'Alt+F12'],
  ['usages', 'Find usages of what the selected node runs', 'Shift+F12'],
  ['enter', 'Go into the selected container or behavior, or to the form of a state', 'Enter'],
  ['form', 'Go to the form of the selected node or container', 'e'],
  ['leave', 'Go out, or select nothing', 'Escape'],
  ['open', 'Open or close the selected container in place', 'o'],
  ['open-all', 'Open every container in place, or close them again', 'Shift+o'],
  ['data-flow', 'Show or hide the data flow: who writes and reads what', 'd'],
  ['notes', 'Show or hide the notes'],
  ['fit', 'Show all', 'f'],
  ['zoom-in', 'Zoom in', '+', '='],
  ['zoom-out', 'Zoom out', '-'],
])

export const COMMAND_TABLE = [...PAGE, ...RUN, ...DOCUMENT, ...BUILD, ...ARRANGE, ...MOVE] as const

export type CommandRow = (typeof COMMAND_TABLE)[number]
export type CommandId = CommandRow['id']
/** The commands of one place. */
export type CommandIdOf<Place extends CommandPlace> = Extract<CommandRow, { readonly place: Place }>['id']
export type RunCommandId = CommandIdOf<'run'>
export type EditorCommandId = CommandIdOf<'editor'>

const BY_ID: ReadonlyMap<string, CommandRow> = new Map(COMMAND_TABLE.map((row) => [row.id, row]))

export function rowOf(id: CommandId): CommandRow {
  const row = BY_ID.get(id)
  if (!row) throw new Error(`there is no command ${id}`)
  return row
}

/** The keys that somebody has given to commands, by their ids. */
export type OwnKeys = Readonly<Partial<Record<CommandId, readonly Chord[]>>>

export function chordsOf(id: CommandId, own: OwnKeys): readonly Chord[] {
  return own[id] ?? rowOf(id).chords
}

/** The command that has a chord already, where the two can be meant on one page. */
export function conflictOf(id: CommandId, chord: Chord, own: OwnKeys): CommandRow | undefined {
  const { place } = rowOf(id)
  return COMMAND_TABLE.find(
    (other) =>
      other.id !== id &&
      (other.place === place || other.place === 'page' || place === 'page') &&
      chordsOf(other.id, own).some((each) => isSameChord(each, chord)),
  )
}

/** The keys with others for one command, taken from whoever has them; with undefined those that it has at first. */
export function withKeys(own: OwnKeys, id: CommandId, chords: readonly Chord[] | undefined): OwnKeys {
  const kept = Object.entries(own).filter(([other]) => other !== id)
  const next = new Map<string, readonly Chord[]>(chords ? [...kept, [id, chords]] : kept)
  const asKeys = (): OwnKeys => Object.fromEntries(next)
  for (const chord of chordsOf(id, asKeys())) {
    for (let other = conflictOf(id, chord, asKeys()); other; other = conflictOf(id, chord, asKeys())) {
      next.set(
        other.id,
        chordsOf(other.id, asKeys()).filter((each) => !isSameChord(each, chord)),
      )
    }
  }
  return asKeys()
}

const BROWSER: readonly Chord[] = keys('Ctrl+t', 'Ctrl+n', 'Ctrl+w', 'Ctrl+Shift+t', 'Ctrl+Shift+n', 'Ctrl+Shift+w', 'Alt+F4', 'F11')
const NAVIGATION: ReadonlySet<string> = new Set(['Tab', 'Enter', ' ', 'Escape', 'ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'])

/** Why a chord can be the key of no command. */
export function refusalOf(chord: Chord): string | undefined {
  if (isSameChord(chord, { key: 'Backspace', ctrl: true, shift: true })) return 'this key stops the cell, on every page'
  if (BROWSER.some((each) => isSameChord(each, chord))) return 'the browser keeps this key for itself'
  if (NAVIGATION.has(chord.key) && !chord.ctrl && !chord.alt) return 'this key moves about on the page and presses buttons'
  return undefined
}

/** Those of a kept map that are keys of a command that there is. */
export function readOwnKeys(kept: unknown): OwnKeys {
  if (typeof kept !== 'object' || kept === null) return {}
  return Object.fromEntries(
    Object.entries(kept).filter(([id, chords]) => BY_ID.has(id) && Array.isArray(chords) && chords.every(isChordData)),
  ) as OwnKeys
}

function isChordData(each: unknown): boolean {
  return typeof each === 'object' && each !== null && 'key' in each && typeof each.key === 'string' && each.key !== ''
}

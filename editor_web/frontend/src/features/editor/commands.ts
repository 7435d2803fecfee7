/** Every command of the editor with its words and keys: for the keyboard, the palette and the sheet. */
import { openSearch } from '../../api/search'
import { isChord, type Press } from '../../document/editing/keys'
import { isMachine, isTreePart, nodeOf, ROOT } from '../../document/editing/model'
import { canRedo, canUndo } from '../../document/editing/history'
import { parentPath } from '../../document/path'
import {
  autoConnect,
  choose,
  copy,
  duplicate,
  enter,
  focusNode,
  group,
  leave,
  makeInitial,
  paste,
  remove,
  selectAlike,
  selectAll,
  openOrCloseAll,
  toggleOpen,
  ungroup,
} from './actions'
import { redo, undo } from './apply'
import { ARRANGING } from './arranging'
import type { Command } from './command'
import { toggleDisabled } from './disabled'
import { openAddPalette, openConnectPalette } from './paletteRequests'
import { toggleDataFlow } from './dataFlow'
import { exportPicture } from './exporting'
import { openFileDialog } from './fileDialogs'
import { openReferred, pageActions } from './pageActions'
import { goToProblem } from './problems'
import { toggleReference } from './references'
import { discard, save } from './session'
import { toggleNotes, writeNote } from './notes'
import { chosenOf, editor, isDirty, isOpenNow, rootOf, setEditor } from './store'

function withChosen(act: (path: string) => void): void {
  const chosen = chosenOf(editor())
  if (chosen && chosen.path !== ROOT) act(chosen.path)
}

export const COMMANDS: readonly Command[] = [
  { id: 'save', part: 'Document', words: 'Save', chords: [{ key: 's', ctrl: true }], run: () => void save() },
  {
    id: 'run',
    part: 'Document',
    words: 'Save, check, and go to the run page',
    chords: [{ key: 'Enter', ctrl: true }],
    run: () => pageActions().run(),
  },
  {
    id: 'run-from',
    part: 'Document',
    words: 'Run from here…',
    chords: [],
    needs: 'node',
    run: () => withChosen((path) => pageActions().run({ path, kind: 'from' })),
  },
  {
    id: 'run-to',
    part: 'Document',
    words: 'Run to here…',
    chords: [],
    needs: 'node',
    run: () => withChosen((path) => pageActions().run({ path, kind: 'to' })),
  },
  { id: 'undo', part: 'Document', words: 'Undo', chords: [{ key: 'z', ctrl: true }], needs: 'undo', run: undo },
  {
    id: 'redo',
    part: 'Document',
    words: 'Redo',
    chords: [
      { key: 'z', ctrl: true, shift: true },
      { key: 'y', ctrl: true },
    ],
    needs: 'redo',
    run: redo,
  },
  {
    id: 'discard',
    part: 'Document',
    words: 'Go back to the file as saved',
    chords: [],
    needs: 'changes',
    run: () => void discard(),
  },
  {
    id: 'text',
    part: 'Document',
    words: 'Show or hide the text',
    chords: [{ key: 'y' }],
    run: () => setEditor({ isTextShown: !editor().isTextShown }),
  },
  {
    id: 'settings',
    part: 'Document',
    words: 'Parameters, userdata and outcomes of the behavior',
    chords: [{ key: ',' }],
    run: () => setEditor({ tab: 'document' }),
  },
  {
    id: 'versions',
    part: 'Document',
    words: 'Versions: compare and restore',
    chords: [{ key: 'h' }],
    run: () => openFileDialog('versions'),
  },
  { id: 'svg', part: 'Document', words: 'Export as SVG', chords: [], run: () => void exportPicture('svg') },
  { id: 'png', part: 'Document', words: 'Export as PNG', chords: [], run: () => void exportPicture('png') },
  { id: 'problem', part: 'Document', words: 'Go to the next problem', chords: [{ key: 'F8' }], run: goToProblem },
  {
    id: 'palette',
    part: 'Document',
    words: 'Every command, every node',
    chords: [{ key: 'k', ctrl: true }],
    run: openSearch,
  },
  {
    id: 'sheet',
    part: 'Document',
    words: 'This list of keys',
    chords: [{ key: '?' }],
    run: () => setEditor({ isSheetShown: true }),
  },

  {
    id: 'add',
    part: 'Build',
    words: 'Add a state or container',
    chords: [{ key: 'a' }, { key: 'Insert' }],
    run: () => openAddPalette(),
  },
  {
    id: 'connect',
    part: 'Build',
    words: 'Connect an outcome of the selected node',
    chords: [{ key: 'c' }],
    needs: 'node',
    run: openConnectPalette,
  },
  {
    id: 'auto',
    part: 'Build',
    words: 'Add obvious transitions',
    chords: [{ key: 'w' }],
    run: () => void autoConnect(),
  },
  {
    id: 'initial',
    part: 'Build',
    words: 'Let the machine begin with the selected node',
    chords: [{ key: 'i' }],
    needs: 'node',
    run: () => void makeInitial(),
  },
  {
    id: 'rename',
    part: 'Build',
    words: 'Rename',
    chords: [{ key: 'F2' }],
    needs: 'node',
    run: () => withChosen((path) => setEditor({ renaming: path })),
  },
  {
    id: 'disable',
    part: 'Build',
    words: 'Disable the selected nodes, or enable them again',
    chords: [{ key: 'x' }],
    needs: 'nodes',
    run: () => void toggleDisabled(),
  },
  {
    id: 'note',
    part: 'Build',
    words: 'Add a note to the selected node, or to the container on the canvas',
    chords: [{ key: 'n' }],
    run: () => writeNote(),
  },
  { id: 'notes', part: 'Move around', words: 'Show or hide the notes', chords: [], run: toggleNotes },
  {
    id: 'remove',
    part: 'Build',
    words: 'Delete',
    chords: [{ key: 'Delete' }, { key: 'Backspace' }],
    run: () => void remove(),
  },
  {
    id: 'duplicate',
    part: 'Build',
    words: 'Duplicate',
    chords: [{ key: 'd', ctrl: true }],
    needs: 'nodes',
    run: () => void duplicate(),
  },
  {
    id: 'copy',
    part: 'Build',
    words: 'Copy',
    chords: [{ key: 'c', ctrl: true }],
    needs: 'nodes',
    run: () => void copy(),
  },
  {
    id: 'cut',
    part: 'Build',
    words: 'Cut',
    chords: [{ key: 'x', ctrl: true }],
    needs: 'nodes',
    run: () => void copy(true),
  },
  { id: 'paste', part: 'Build', words: 'Paste', chords: [{ key: 'v', ctrl: true }], run: () => void paste() },
  {
    id: 'group',
    part: 'Build',
    words: 'Group into a machine',
    chords: [{ key: 'g', ctrl: true }],
    needs: 'nodes',
    run: () => void group('machine'),
  },
  {
    id: 'group-concurrency',
    part: 'Build',
    words: 'Group to run side by side',
    chords: [],
    needs: 'nodes',
    run: () => void group('concurrency'),
  },
  {
    id: 'ungroup',
    part: 'Build',
    words: 'Ungroup',
    chords: [{ key: 'g', ctrl: true, shift: true }],
    needs: 'node',
    run: () => void ungroup(),
  },

  ...ARRANGING,
  {
    id: 'all',
    part: 'Move around',
    words: 'Select everything here',
    chords: [{ key: 'a', ctrl: true }],
    run: selectAll,
  },
  {
    id: 'alike',
    part: 'Move around',
    words: 'Select every node that runs the same',
    chords: [],
    needs: 'node',
    run: selectAlike,
  },
  {
    id: 'enter',
    part: 'Move around',
    words: 'Go into the selected container or behavior, or to the form of a state',
    chords: [{ key: 'Enter' }],
    needs: 'node',
    run: goIn,
  },
  { id: 'leave', part: 'Move around', words: 'Go out, or select nothing', chords: [{ key: 'Escape' }], run: goOut },
  {
    id: 'open',
    part: 'Move around',
    words: 'Open or close the selected container in place',
    chords: [{ key: 'o' }],
    needs: 'node',
    run: openOrClose,
  },
  {
    id: 'open-all',
    part: 'Move around',
    words: 'Open every container in place, or close them again',
    chords: [{ key: 'O', shift: true }],
    run: openOrCloseAll,
  },
  {
    id: 'data-flow',
    part: 'Move around',
    words: 'Show or hide the data flow: who writes and reads what',
    chords: [{ key: 'd' }],
    run: toggleDataFlow,
  },
  { id: 'fit', part: 'Move around', words: 'Show all', chords: [{ key: 'f' }], run: () => pageActions().fit() },
  {
    id: 'zoom-in',
    part: 'Move around',
    words: 'Zoom in',
    chords: [{ key: '+' }, { key: '=' }],
    run: () => pageActions().zoom(1.3),
  },
  {
    id: 'zoom-out',
    part: 'Move around',
    words: 'Zoom out',
    chords: [{ key: '-' }],
    run: () => pageActions().zoom(1 / 1.3),
  },
]

/** Go into a container, to the behavior that is referred to, or to the form of a state. */
function goIn(): void {
  withChosen((path) => {
    const node = nodeOf(rootOf(editor()), path)
    if (!node) return
    if (node.document) openReferred(node.document, path)
    else if (node.children.length > 0 || isMachine(node.kind) || node.kind === 'concurrency') enter(path)
    else focusInspector()
  })
}

/** Put the keyboard on the first parameter of the selected node, else on the first field of its form. */
function focusInspector(): void {
  setEditor({ tab: 'node' })
  requestAnimationFrame(() => {
    const form = document.querySelector('[data-inspector] [data-form]')
    const field =
      form?.querySelector<HTMLElement>('[data-parameters] :is(input, select)') ??
      form?.querySelector<HTMLElement>('input, select, textarea')
    field?.focus()
  })
}

/** One step back: from an arrow, from several nodes to one, from a node to what is around it, from a container to the one around. */
function goOut(): void {
  const { selection, scope, arrow } = editor()
  if (arrow) setEditor({ arrow: undefined })
  else if (selection.length > 1) choose(selection.slice(-1))
  else if (selection.length === 1 && parentPath(selection[0] ?? '') !== scope) {
    const up = parentPath(selection[0] ?? '')
    choose([up])
    focusNode(up)
  } else leave()
}

function openOrClose(): void {
  withChosen((path) => {
    const node = nodeOf(rootOf(editor()), path)
    if (node?.document) void toggleReference(path)
    else if (node && (node.children.length > 0 || !isTreePart(node.kind))) toggleOpen(path, isOpenNow(editor(), path))
  })
}

/** Why a command cannot be used now, or nothing. */
export function disabledReason(command: Command): string | undefined {
  const state = editor()
  switch (command.needs) {
    case 'node':
    case 'nodes':
      return state.selection.length === 0 ? 'select a node first' : undefined
    case 'undo':
      // What is on its way to the server now can be taken back as soon as it is there.
      return state.isBusy || canUndo(state.history) ? undefined : 'nothing was changed'
    case 'redo':
      return canRedo(state.history) ? undefined : 'nothing was undone'
    case 'changes':
      return isDirty(state) ? undefined : 'nothing was changed'
    default:
      return undefined
  }
}

/** The command that a key press means, if any. */
export function commandOf(press: Press): Command | undefined {
  return COMMANDS.find((command) => command.chords.some((chord) => isChord(press, chord)))
}

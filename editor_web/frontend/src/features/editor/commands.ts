/** What every command of the editor does: for the keyboard, the palette and the menus. */
import { commandOf as meantBy } from '../../api/keyMap'
import { findUsages } from '../../api/usages'
import type { Press } from '../../document/chord'
import { COMMAND_TABLE, type EditorCommandId } from '../../document/commandTable'
import { usedBy } from '../../document/editing/usedBy'
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
import type { Action, Command } from './command'
import { toggleDisabled } from './disabled'
import { openAddPalette, openConnectPalette } from './paletteRequests'
import { toggleDataFlow } from './dataFlow'
import { exportPicture } from './exporting'
import { openFileDialog } from './fileDialogs'
import { openReferred, pageActions } from './pageActions'
import { goToProblem } from './problems'
import { toggleReference } from './references'
import { discard, save } from './session'
import { addFreeNote } from './freeNotes'
import { toggleNotes, writeNote } from './notes'
import { showSourceOf } from './stateSource'
import { openReplacePalette } from './typeReplacement'
import { chosenOf, editor, isDirty, isOpenNow, rootOf, setEditor } from './store'

function withChosen(act: (path: string) => void): void {
  const chosen = chosenOf(editor())
  if (chosen && chosen.path !== ROOT) act(chosen.path)
}

const ACTIONS: Readonly<Record<EditorCommandId, Action>> = {
  save: { run: () => void save() },
  run: { run: () => pageActions().run() },
  'run-from': { needs: 'node', run: () => withChosen((path) => pageActions().run({ path, kind: 'from' })) },
  'run-to': { needs: 'node', run: () => withChosen((path) => pageActions().run({ path, kind: 'to' })) },
  undo: { needs: 'undo', run: undo },
  redo: { needs: 'redo', run: redo },
  discard: { needs: 'changes', run: () => void discard() },
  text: { run: () => setEditor({ isTextShown: !editor().isTextShown }) },
  settings: { run: () => setEditor({ tab: 'document' }) },
  versions: { run: () => openFileDialog('versions') },
  svg: { run: () => void exportPicture('svg') },
  png: { run: () => void exportPicture('png') },
  pdf: { run: () => void exportPicture('pdf') },
  problem: { run: goToProblem },

  add: { run: () => openAddPalette() },
  connect: { needs: 'node', run: openConnectPalette },
  auto: { run: () => void autoConnect() },
  initial: { needs: 'node', run: () => void makeInitial() },
  replace: { run: () => openReplacePalette() },
  rename: { needs: 'node', run: () => withChosen((path) => setEditor({ renaming: path })) },
  disable: { needs: 'nodes', run: () => void toggleDisabled() },
  note: { run: () => writeNote() },
  'free-note': { run: addFreeNote },
  remove: { run: () => void remove() },
  duplicate: { needs: 'nodes', run: () => void duplicate() },
  copy: { needs: 'nodes', run: () => void copy() },
  cut: { needs: 'nodes', run: () => void copy(true) },
  paste: { run: () => void paste() },
  group: { needs: 'nodes', run: () => void group('machine') },
  'group-concurrency': { needs: 'nodes', run: () => void group('concurrency') },
  ungroup: { needs: 'node', run: () => void ungroup() },

  ...ARRANGING,
  all: { run: selectAll },
  alike: { needs: 'node', run: selectAlike },
  source: { needs: 'node', run: () => showSourceOf(chosenOf(editor())) },
  usages: { needs: 'node', run: () => findUsages(usedBy(chosenOf(editor()))) },
  enter: { needs: 'node', run: goIn },
  form: { needs: 'node', run: focusInspector },
  leave: { run: goOut },
  open: { needs: 'node', run: openOrClose },
  'open-all': { run: openOrCloseAll },
  'data-flow': { run: toggleDataFlow },
  notes: { run: toggleNotes },
  fit: { run: () => pageActions().fit() },
  'zoom-in': { run: () => pageActions().zoom(1.3) },
  'zoom-out': { run: () => pageActions().zoom(1 / 1.3) },
}

/** In the order of the table. */
export const COMMANDS: readonly Command[] = COMMAND_TABLE.flatMap((row) =>
  row.place === 'editor' ? [{ id: row.id, words: row.words, part: row.part, ...ACTIONS[row.id] }] : [],
)

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
  const id = meantBy(press, 'editor')
  return COMMANDS.find((command) => command.id === id)
}

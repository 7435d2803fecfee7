/** Notes on the canvas: whether they are shown, and which one is being written. */
import { setField } from '../../document/editing/edits'
import { isForeign, nodeOf, ROOT } from '../../document/editing/model'
import { perform } from './apply'
import { chosenOf, editor, showEditorRefusal, rootOf } from './store'
import { pageStore } from '../../api/pageStore'

export const useNotes = pageStore<{ readonly isShown: boolean; readonly writing: string | undefined }>(() => ({
  isShown: true,
  writing: undefined,
}))

export function toggleNotes(): void {
  useNotes.setState((state) => ({ isShown: !state.isShown, writing: undefined }))
}

/** Write a note on the selected node; on what fills the canvas where none is chosen. */
export function writeNote(path = chosenOf(editor())?.path ?? editor().scope): void {
  const root = rootOf(editor())
  if (!root || !nodeOf(root, path)) return
  if (isForeign(root, path)) showEditorRefusal('Note', 'this is part of another behavior', 'Open that behavior and write it there.')
  else useNotes.setState({ isShown: true, writing: path })
}

export async function keepNote(path: string, text: string): Promise<void> {
  // Escape and the loss of the keyboard that follows it are one.
  if (useNotes.getState().writing !== path) return
  useNotes.setState({ writing: undefined })
  const node = nodeOf(rootOf(editor()), path)
  if (!node || node.notes === text.trim()) return
  await perform(`Note on ${path === ROOT ? 'the behavior' : node.name}`, [setField(path, 'notes', text.trim() || null)])
}

export function dropNote(): void {
  useNotes.setState({ writing: undefined })
}

/** Opening, editing and saving of a document of the cell. Nothing of it moves anything: the open cell is as it was opened. */
import { wordsOf } from '../../api/client'
import { cellDocuments, type CellEdit } from '../../api/cellDocuments'
import { conflictOf } from '../../api/documents'
import { pageStore } from '../../api/pageStore'
import { canRedo, canUndo, jumped, newHistory, pushed, replaced, settled } from '../../document/editing/history'
import { Pause } from '../../document/pause'
import { blank, cellEditor, draftOf, setCellEditor, useCellEditor, type CellText } from './store'

const PAUSE_MS = 250

/** What was asked for, one after the other, and the pause after typing. */
const turns = pageStore(
  () => ({ last: Promise.resolve(), pause: new Pause() }),
  ({ pause }) => pause.cancel(),
)

function inTurn<T>(act: () => Promise<T>): Promise<T> {
  const made = turns.getState().last.then(act)
  turns.setState({
    last: made.then(
      () => undefined,
      () => undefined,
    ),
  })
  return made
}

function refuse(what: string, message: string, hint = ''): void {
  setCellEditor({ notice: { what, message, hint } })
}

export async function openCellDocument(id: string): Promise<void> {
  turns.getState().pause.cancel()
  useCellEditor.setState({ ...blank(), steps: cellEditor().steps, id, phase: 'loading' }, true)
  try {
    const { draft } = await cellDocuments.open(id)
    if (cellEditor().id !== id) return
    setCellEditor({ phase: 'ready', base: draft, history: newHistory<CellText>(draft) })
  } catch (error) {
    if (cellEditor().id === id) setCellEditor({ phase: 'failed', problem: wordsOf(error) })
  }
}

export function closeCellDocument(): void {
  turns.getState().pause.cancel()
  useCellEditor.setState(blank(), true)
}

/** Make edits, all or none; whether they were made. */
export function edit(label: string, edits: readonly CellEdit[]): Promise<boolean> {
  return inTurn(async () => {
    await readTyped()
    const { id } = cellEditor()
    setCellEditor({ isBusy: true })
    try {
      const { draft, refused } = await cellDocuments.edit(id, draftOf(cellEditor()).text, edits)
      if (cellEditor().id !== id) return false
      if (refused) {
        refuse(label, refused.message, refused.hint)
        return false
      }
      setCellEditor({ notice: undefined, history: pushed(settled(cellEditor().history), label, draft) })
      return true
    } catch (error) {
      refuse(label, wordsOf(error))
      return false
    } finally {
      setCellEditor({ isBusy: false })
    }
  })
}

/** The text was typed: what it says is asked for after a pause. */
export function typed(text: string): void {
  const { history } = cellEditor()
  setCellEditor({ history: pushed(history, 'Typing', { ...draftOf(cellEditor()), text, isStale: true }, 'typing') })
  turns.getState().pause.later(PAUSE_MS, () => void inTurn(readTyped))
}

async function readTyped(): Promise<void> {
  turns.getState().pause.cancel()
  const { id } = cellEditor()
  const { text, isStale } = draftOf(cellEditor())
  if (!isStale) return
  try {
    const draft = await cellDocuments.draft(id, text)
    // What was typed meanwhile is read after the next pause.
    if (cellEditor().id === id && draftOf(cellEditor()).text === text) setCellEditor({ history: replaced(cellEditor().history, draft) })
  } catch (error) {
    refuse('Read the text', wordsOf(error))
  }
}

export function jumpTo(at: number): void {
  setCellEditor({ history: jumped(settled(cellEditor().history), at), notice: undefined })
  void inTurn(readTyped)
}

export function undo(): void {
  const { history } = cellEditor()
  if (canUndo(history)) jumpTo(history.at - 1)
}

export function redo(): void {
  const { history } = cellEditor()
  if (canRedo(history)) jumpTo(history.at + 1)
}

/** Write the draft to disk; whether it is there. Lines that only the file has changed are taken with it. */
export async function save(): Promise<boolean> {
  const isSaved = await inTurn(async () => {
    await readTyped()
    const { id, base } = cellEditor()
    const { text } = draftOf(cellEditor())
    if (text === base.text) return true
    setCellEditor({ isBusy: true })
    try {
      const { hash } = await cellDocuments.save(id, text, base.hash)
      setCellEditor({ base: { text, hash }, notice: undefined, conflict: undefined })
      return true
    } catch (error) {
      const conflict = conflictOf(error)
      if (conflict) setCellEditor({ conflict })
      else refuse('Save', wordsOf(error), 'The text is kept on this page; try again.')
      return false
    } finally {
      setCellEditor({ isBusy: false })
    }
  })
  const { conflict } = cellEditor()
  if (isSaved || !conflict?.merge) return isSaved
  await takeText('Merge with the file', conflict.merge.text, conflict)
  return save()
}

/** End a conflict: `theirs` is taken as it is on disk, `mine` is saved in its place. */
export async function resolve(side: 'mine' | 'theirs'): Promise<void> {
  const { conflict } = cellEditor()
  if (!conflict) return
  if (side === 'theirs') return takeText('Take the file', conflict.theirs, conflict)
  setCellEditor({ conflict: undefined, base: { text: conflict.theirs, hash: conflict.theirs_hash } })
  await save()
}

async function takeText(
  label: string,
  text: string,
  { theirs, theirs_hash: hash }: { theirs: string; theirs_hash: string },
): Promise<void> {
  const { history } = cellEditor()
  const draft = { ...draftOf(cellEditor()), text, isStale: true }
  setCellEditor({ conflict: undefined, base: { text: theirs, hash }, history: pushed(settled(history), label, draft) })
  await inTurn(readTyped)
}

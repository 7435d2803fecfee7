/** Opening and saving: the file, the kept draft, and what to do when both have changed. */
import { wordsOf } from '../../api/client'
import { conflictOf, documents } from '../../api/documents'
import { newHistory, pushed, replaced } from '../../document/editing/history'
import { nodeOf, ROOT } from '../../document/editing/model'
import { parentPath } from '../../document/path'
import { draftFrom, inTurn, lookForFindings, readAnew, takeText } from './apply'
import { deleteStoredDraft, storeDraftNow, storedDraft } from './draftStorage'
import { blank, draftOf, editor, isDirty, showEditorRefusal, setEditor, showEditorNotice, useEditor } from './store'

/** Read a document and everything that can be put into it; a draft from an earlier visit is taken up. */
export async function openDocument(id: string, node: string): Promise<void> {
  useEditor.setState(blank(id), true)
  try {
    const catalogue = documents.catalogue().catch((error: unknown) => {
      showEditorRefusal('Library', wordsOf(error), 'Load the page again.')
      return undefined
    })
    const answer = await documents.open(id)
    if (editor().id !== id) return
    const kept = storedDraft(id)
    const draft = draftFrom(answer, answer.text, undefined)
    setEditor({ phase: 'ready', base: { text: answer.text, hash: answer.hash }, history: newHistory(draft) })
    if (kept && kept.text !== answer.text) await takeUp(kept.text, kept.base, kept.baseText)
    else void lookForFindings()
    reveal(node)
    // What can be put in is not needed to see what is there.
    const found = await catalogue
    if (editor().id === id) setEditor({ catalogue: found })
  } catch (error) {
    if (editor().id === id) setEditor({ phase: 'failed', problem: wordsOf(error) })
  }
}

async function takeUp(text: string, base: string, baseText: string): Promise<void> {
  const { history, base: disk } = editor()
  setEditor({
    history: pushed(history, 'Draft of an earlier visit', { ...draftOf(editor()), text, isChecked: false, areTargetsKnown: false }),
    base: { text: baseText, hash: base },
    isRestored: true,
    isOutdated: base !== disk.hash,
  })
  await readAnew()
}

/** Show a node: go to the container around it and choose it. */
export function reveal(path: string): void {
  const node = nodeOf(draftOf(editor()).root, path)
  if (!node || path === ROOT) return
  setEditor({ selection: [path], arrow: undefined, shown: { path }, tab: 'node' })
  const { scope } = editor()
  if (!path.startsWith(`${scope}/`)) setEditor({ scope: parentPath(path) || ROOT })
}

/** Write the draft to disk; true when it is there. Where the file has changed meanwhile, nothing is written and both are shown. */
export function save(): Promise<boolean> {
  return inTurn(async () => {
    const { id, base } = editor()
    const { text } = draftOf(editor())
    if (!isDirty(editor()) && !editor().isOutdated) return true
    try {
      const { hash } = await documents.save(id, text, base.hash)
      setEditor({ base: { text, hash }, notice: undefined, conflict: undefined, isRestored: false, isOutdated: false })
      storeDraftNow()
      showEditorNotice('Saved')
      return true
    } catch (error) {
      const conflict = conflictOf(error)
      if (conflict) setEditor({ conflict })
      else showEditorRefusal('Save', wordsOf(error), 'The draft is kept in this browser; try again.')
      return false
    }
  })
}

/** Which text to go on with when the file has changed under the draft. */
export type Side = 'merged' | 'theirs' | 'mine'

/** End a conflict: `theirs` is taken as it is on disk, the others are saved in its place. */
export async function resolve(side: Side): Promise<void> {
  const { conflict } = editor()
  if (!conflict) return
  const text = side === 'theirs' ? conflict.theirs : side === 'merged' ? (conflict.merged ?? '') : draftOf(editor()).text
  setEditor({ conflict: undefined, isOutdated: false, base: { text: conflict.theirs, hash: conflict.theirs_hash } })
  if (side !== 'mine') await takeText(side === 'merged' ? 'Merge with the file' : 'Take the file', text)
  if (side !== 'theirs') await save()
  else storeDraftNow()
}

/** Go back to the file as it is on disk; the draft stays in the history. */
export async function discard(): Promise<void> {
  const { id } = editor()
  try {
    const answer = await documents.open(id)
    setEditor({ base: { text: answer.text, hash: answer.hash }, isRestored: false, isOutdated: false })
    await takeText('Go back to the file', answer.text)
    deleteStoredDraft(id)
  } catch (error) {
    showEditorRefusal('Go back to the file', wordsOf(error))
  }
}

/** Look at the file: one that has changed is taken where there is no draft, and announced where there is. */
export async function lookAtDisk(): Promise<void> {
  const { id, phase } = editor()
  if (phase !== 'ready') return
  const answer = await documents.open(id).catch(() => undefined)
  const now = editor()
  if (!answer || now.id !== id || answer.hash === now.base.hash) return
  if (isDirty(now)) {
    setEditor({ isOutdated: true })
    return
  }
  setEditor({ base: { text: answer.text, hash: answer.hash } })
  setEditor({
    history: replaced(
      pushed(now.history, 'Changed on disk', draftFrom(answer, answer.text, draftOf(now))),
      draftFrom(answer, answer.text, draftOf(now)),
    ),
  })
  void lookForFindings()
}

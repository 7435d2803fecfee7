/** Opening and saving: the file, the kept draft, and what to do when both have changed. */
import { wordsOf } from '../../api/client'
import { conflictOf, documents } from '../../api/documents'
import { relations } from '../../api/relations'
import type { ConflictBody, NodeConflict } from '../../api/types'
import { isError } from '../../document/editing/findings'
import { newHistory, pushed, replaced } from '../../document/editing/history'
import { nodeOf, ROOT } from '../../document/editing/model'
import { nameOfPath, parentPath } from '../../document/path'
import { draftFrom, inTurn, lookForFindings, readAnew, takeText } from './apply'
import { deleteStoredDraft, storeDraftNow, storedDraft } from './draftStorage'
import { blank, draftOf, editor, isDirty, showEditorRefusal, setEditor, showEditorNotice, useEditor } from './store'

/** Read a document and everything that can be put into it; a draft from an earlier visit is taken up. */
export async function openDocument(id: string, node: string): Promise<void> {
  // What is shown already and on its way to the server is part of the draft that is left.
  if (editor().unwritten.length > 0) await inTurn(() => Promise.resolve())
  storeDraftNow()
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

/** Classes of states were loaded anew: what can be put in, and what is wrong with the text, is asked again. */
export async function takeStates(): Promise<void> {
  const { id } = editor()
  try {
    const catalogue = await documents.catalogue()
    if (editor().id === id) setEditor({ catalogue })
  } catch (error) {
    showEditorRefusal('Library', wordsOf(error), 'Load the page again.')
  }
  if (editor().id === id) await readAnew()
}

/** Show a node: go to the container around it and choose it. */
export function reveal(path: string): void {
  const node = nodeOf(draftOf(editor()).root, path)
  if (!node || path === ROOT) return
  setEditor({ selection: [path], arrow: undefined, shown: { path }, tab: 'node' })
  const { scope } = editor()
  if (!path.startsWith(`${scope}/`)) setEditor({ scope: parentPath(path) || ROOT })
}

/** So often in a row a save is merged with a file that has changed again. */
const MOST_MERGES = 3

/** Write the draft to disk; true when it is there. Where the file has changed meanwhile, both changes are merged by nodes. */
export async function save(merges = 0): Promise<boolean> {
  const met = await inTurn(write)
  if (typeof met === 'boolean') return met
  if (met.merge?.conflicts.length === 0) {
    if (merges < MOST_MERGES) return takeMerged(met, merges)
    showEditorRefusal('Save', `the file has changed ${merges + 1} times meanwhile.`, 'Save again when nobody else writes it.')
    return false
  }
  setEditor({ conflict: met, sides: {}, isComparing: met.merge === null })
  return false
}

async function write(): Promise<boolean | ConflictBody> {
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
    if (conflict) return conflict
    showEditorRefusal('Save', wordsOf(error), 'The draft is kept in this browser; try again.')
    return false
  }
}

/** Go on with the merged text and save it, unless the two changes make errors together that neither has alone. */
async function takeMerged({ merge, theirs, theirs_hash: hash }: ConflictBody, merges = 0): Promise<boolean> {
  if (!merge) return false
  await lookForFindings()
  const before = new Set(errorsNow())
  setEditor({ conflict: undefined, isOutdated: false, base: { text: theirs, hash } })
  await takeText('Merge with the file', merge.text)
  await lookForFindings()
  if (errorsNow().some((error) => !before.has(error))) {
    setEditor({ tab: 'problems' })
    showEditorRefusal(
      'Save',
      'merged with the file the behavior has new errors.',
      'See the problems, then save; Undo goes back to your text.',
    )
    return false
  }
  const isSaved = await save(merges + 1)
  const names = merge.theirs_changed.map(nameOfPath).join(', ')
  if (isSaved && names) showEditorNotice(`Saved with changes of the file: ${names}`)
  return isSaved
}

function errorsNow(): readonly string[] {
  return draftOf(editor())
    .findings.filter(isError)
    .map((finding) => `${finding.path} ${finding.code} ${finding.message}`)
}

/** Merge again with the sides that were chosen, and save that. */
export async function saveChosen(): Promise<void> {
  const { id, base, sides } = editor()
  try {
    const met = await documents.merge(id, draftOf(editor()).text, base.hash, sides)
    const open = met.merge?.conflicts.filter((conflict) => !(keyOf(conflict) in sides))
    if (open?.length === 0) await takeMerged(met)
    else setEditor({ conflict: met })
  } catch (error) {
    showEditorRefusal('Save', wordsOf(error))
  }
}

/** What a side is chosen for. */
export function keyOf({ path, field }: NodeConflict): string {
  return `${path} ${field}`
}

/** Which text to go on with as a whole when the file has changed under the draft. */
export type Side = NodeConflict['side']

/** End a conflict: `theirs` is taken as it is on disk, `mine` is saved in its place. */
export async function resolve(side: Side): Promise<void> {
  const { conflict } = editor()
  if (!conflict) return
  setEditor({ conflict: undefined, isOutdated: false, base: { text: conflict.theirs, hash: conflict.theirs_hash } })
  if (side === 'mine') await save()
  else {
    await takeText('Take the file', conflict.theirs)
    storeDraftNow()
  }
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

/** Save the draft where the file was deleted meanwhile. */
export async function writeAgain(): Promise<void> {
  const { id } = editor()
  try {
    const { text, hash } = await relations.restore(id)
    setEditor({ base: { text, hash } })
    await save()
  } catch (error) {
    showEditorRefusal('Save', wordsOf(error), 'The draft is kept in this browser; copy it with Duplicate.')
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

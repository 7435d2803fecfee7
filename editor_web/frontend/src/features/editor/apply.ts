/** Changing the document: edits by the server, typing, undo and redo; one after the other, none lost. */
import { wordsOf, ServerError } from '../../api/client'
import { documents } from '../../api/documents'
import { pageStore } from '../../api/pageStore'
import type { EditAnswer } from '../../api/types'
import type { Edit } from '../../document/editing/edits'
import { sameFindings } from '../../document/editing/findings'
import { shiftedFindings, withDifference } from '../../document/editing/graphDifference'
import { jumped, pushed, redone, replaced, settled, undone, type History } from '../../document/editing/history'
import { areOfLayout } from '../../document/editing/layoutEdits'
import { nodeOf, type Draft, type EditNode } from '../../document/editing/model'
import { withEdits } from '../../document/editing/optimisticEdits'
import { Pause } from '../../document/pause'
import { parentPath } from '../../document/path'
import { lookForNames } from './cellNames'
import { findingsOf } from './checking'
import { storeDraft } from './draftStorage'
import { withReferences } from './references'
import { draftOf, editor, showEditorRefusal, rootOf, setEditor } from './store'
import { lookForTargets } from './targets'

const TYPING_PAUSE_MS = 250

/** What is under way for the editor. */
class Work {
  /** Ends with all that was asked for so far. */
  queue: Promise<unknown> = Promise.resolve()
  readonly typing = new Pause()
  /** Until what is wrong with the present text is known. */
  checking: Promise<void> | undefined
}

const work = pageStore(
  () => new Work(),
  ({ typing }) => typing.cancel(),
)

/** Do something after everything that was asked for before; the editor says meanwhile that it is busy. */
export function inTurn<T>(act: () => Promise<T>): Promise<T> {
  const now = work.getState()
  const done = now.queue.then(async () => {
    setEditor({ isBusy: true })
    try {
      return await act()
    } finally {
      setEditor({ isBusy: false })
    }
  })
  now.queue = done.catch(() => undefined)
  return done
}

/**
 * Apply edits to the text as it then is; undefined with the reason on the page where the server refuses.
 * Edits that say anew what is there already are made of what is there then.
 * What follows from the graph alone is shown at once, and again as before where the server does not write it.
 */
export async function perform(label: string, edits: readonly Edit[] | (() => readonly Edit[])): Promise<EditAnswer | undefined> {
  const { id } = editor()
  const root = rootOf(editor())
  const shown = typeof edits !== 'function' && root && withEdits(root, edits) ? edits : undefined
  if (shown) setEditor({ unwritten: [...editor().unwritten, shown] })
  const done = () => {
    if (shown) setEditor({ unwritten: editor().unwritten.filter((each) => each !== shown) })
  }
  const { notice } = editor()
  const written = () => {
    done()
    // What has been refused since this was asked for is still to be read.
    if (editor().notice === notice) setEditor({ notice: undefined })
  }
  return inTurn(() => performNow(id, label, edits, written)).finally(() => {
    done()
    if (editor().id === id) dropStaleSelection()
  })
}

async function performNow(
  id: string,
  label: string,
  edits: readonly Edit[] | (() => readonly Edit[]),
  written: () => void,
): Promise<EditAnswer | undefined> {
  try {
    // What was typed, or came from the disk, while the server was asked is edited in its turn.
    while (editor().id === id) {
      const before = draftOf(editor())
      const next = typeof edits === 'function' ? edits() : edits
      if (next.length === 0) return undefined
      const isLayout = areOfLayout(next) && before.isChecked
      const answer = await documents.edit(id, before.text, next, { check: !isLayout, graph: before.hash || null })
      if (editor().id !== id) break
      if (draftOf(editor()).text !== before.text) continue
      if (answer.refused) {
        showEditorRefusal(label, answer.refused.message, answer.refused.hint)
        return undefined
      }
      const draft = draftAfter(answer, before, isLayout)
      if (!draft) {
        // The graph of the page is not the one that the server knows: it is asked for whole.
        setEditor({ history: replaced(editor().history, { ...before, hash: '' }) })
        continue
      }
      written()
      setHistory(pushed(settled(editor().history), label, draft))
      return answer
    }
  } catch (error) {
    if (editor().id === id) showEditorRefusal(label, ...reasonOf(error))
  }
  return undefined
}

/** The draft after an edit; undefined where the answer is the difference from another graph. */
function draftAfter(answer: EditAnswer, before: Draft, isLayout: boolean): Draft | undefined {
  const { difference } = answer
  if (!difference) return draftFrom(answer, answer.text, before)
  const graph = before.root && before.hash === difference.base ? withDifference(before.root, difference) : undefined
  if (!graph) return undefined
  const draft = draftFrom({ ...answer, graph }, answer.text, before)
  if (!isLayout || answer.checked) return draft
  const [findings, targets] = [shiftedFindings(before.findings, difference), shiftedFindings(before.targets, difference)]
  return { ...draft, findings, isChecked: true, targets, areTargetsKnown: before.areTargetsKnown }
}

/** The same for a node, with edits that are made of what it is by then: for lists and mappings, which are sent as a whole. */
export function performOn(path: string, label: string, edits: (now: EditNode) => readonly Edit[]): Promise<EditAnswer | undefined> {
  return perform(label, () => {
    const now = nodeOf(draftOf(editor()).root, path)
    return now ? edits(now) : []
  })
}

function reasonOf(error: unknown): [string, string] {
  return error instanceof ServerError ? [error.body.message, error.body.hint] : [wordsOf(error), '']
}

interface Read {
  readonly hash: string
  readonly graph: Draft['root'] | null
  readonly findings: Draft['findings']
  readonly checked: boolean
  readonly document?: Draft['document'] | null
}

/** A draft of what the server read; where it could not, with the graph from before. */
export function draftFrom(answer: Read, text: string, before: Draft | undefined): Draft {
  const isStale = !answer.graph
  return {
    text,
    root: answer.graph ?? before?.root,
    hash: isStale ? (before?.hash ?? '') : answer.hash,
    findings: answer.checked ? sameFindings(before?.findings, answer.findings) : (before?.findings ?? []),
    isChecked: answer.checked,
    targets: before?.targets ?? [],
    areTargetsKnown: false,
    isStale,
    document: (isStale ? before?.document : answer.document) ?? undefined,
  }
}

/** Ask what is wrong with the present text, until that is known; edits go on meanwhile. */
export function lookForFindings(): Promise<void> {
  const now = work.getState()
  now.checking ??= Promise.resolve()
    .then(() => look(now))
    .catch((error: unknown) => showEditorRefusal('Check', ...reasonOf(error)))
  return now.checking
}

async function look(of: Work): Promise<void> {
  try {
    for (;;) {
      const { id } = editor()
      const { text, isChecked } = draftOf(editor())
      if (isChecked || !id) return
      const findings = await findingsOf(id, text)
      const now = draftOf(editor())
      if (editor().id === id && now.text === text) {
        const known = { ...now, findings: sameFindings(now.findings, findings), isChecked: true }
        setEditor({ history: replaced(editor().history, known) })
      }
    }
  } finally {
    // At once, not a turn later: a text that comes in between would wait for a look that is over.
    of.checking = undefined
    lookForTargets()
    void lookForNames()
  }
}

function setHistory(history: History): void {
  setEditor({ history: withReferences(history) })
  storeDraft()
  dropStaleSelection()
  void lookForFindings()
}

/** What is chosen or shown and is not there any more is let go. */
function dropStaleSelection(): void {
  const state = editor()
  const root = rootOf(state)
  const selection = state.selection.filter((path) => nodeOf(root, path))
  let scope = state.scope
  while (scope && !nodeOf(root, scope)) scope = parentPath(scope)
  setEditor({
    ...(selection.length === state.selection.length ? {} : { selection }),
    ...(scope === state.scope ? {} : { scope: scope || 'root' }),
  })
}

/** Take what was typed into the text; the graph follows when the typing pauses. */
export function typed(text: string): void {
  const before = draftOf(editor())
  if (text === before.text) return
  setEditor({ history: pushed(editor().history, 'Type', { ...before, text, isChecked: false, areTargetsKnown: false }, 'typing') })
  storeDraft()
  work.getState().typing.later(TYPING_PAUSE_MS, () => void readAnew())
}

/** Ask the server what it reads in the present text. */
export function readAnew(): Promise<void> {
  work.getState().typing.cancel()
  const { id } = editor()
  return inTurn(async () => {
    const before = draftOf(editor())
    const answer = await documents.draft(id, before.text)
    if (editor().id === id && draftOf(editor()).text === before.text) {
      setHistory(replaced(editor().history, draftFrom(answer, before.text, before)))
    }
  }).catch((error: unknown) => showEditorRefusal('Check', ...reasonOf(error)))
}

export function undo(): void {
  go(undone)
}

export function redo(): void {
  go(redone)
}

/** Undo or redo all steps up to one. */
export function jumpTo(at: number): void {
  go((history) => jumped(history, at))
}

function go(step: (history: History) => History): void {
  const { id } = editor()
  void inTurn(() => {
    if (editor().id === id) setHistory(step(settled(editor().history)))
    return Promise.resolve()
  })
}

/** Put a whole text in place of the present one, as one step that can be undone. */
export function takeText(label: string, text: string): Promise<void> {
  const before = draftOf(editor())
  setEditor({ history: pushed(settled(editor().history), label, { ...before, text, isChecked: false, areTargetsKnown: false }) })
  return readAnew()
}

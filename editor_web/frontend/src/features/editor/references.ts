/** Behaviors that are referred to: seen in place, opened in their own page, and the way back from there. */
import { lookup, type Dict } from '../../document/dict'
import { wordsOf } from '../../api/client'
import { documents } from '../../api/documents'
import { inlineReferences } from '../../document/editing/referenceInlining'
import { replaced, presentOf, type History } from '../../document/editing/history'
import { nodeOf, type EditNode } from '../../document/editing/model'
import { nameOfPath } from '../../document/path'
import { draftOf, editor, isOpenNow, showEditorRefusal, rootOf, setEditor } from './store'

function roots(): ReadonlyMap<string, EditNode> {
  return new Map([...editor().bodies].map(([id, body]) => [id, body.root]))
}

/** A history whose present draft shows the insides of the references that were opened. */
export function withReferences(history: History): History {
  const { draft } = presentOf(history)
  const root = draft.root && inlineReferences(draft.root, roots())
  return root === draft.root ? history : replaced(history, { ...draft, root })
}

/** Show what is inside of a reference here, or close it. */
export async function toggleReference(path: string): Promise<void> {
  const node = nodeOf(rootOf(editor()), path)
  if (!node?.document) return
  const isOpen = node.children.length > 0 && isOpenNow(editor(), path)
  if (!isOpen && node.children.length === 0 && !(await load(node.document))) return
  setEditor({ opened: new Map(editor().opened).set(path, !isOpen).set(`${path}/root`, true) })
}

async function load(id: string): Promise<boolean> {
  const { id: edited } = editor()
  try {
    const { graph, hash, document } = await documents.open(id)
    if (editor().id !== edited) return false
    if (!graph) {
      showEditorRefusal('Open in place', `${id} cannot be read`, 'Open it in its own page and mend it.')
      return false
    }
    const body = { hash, root: { ...graph, name: document?.name || graph.name } }
    setEditor({ bodies: new Map(editor().bodies).set(id, body) })
    setEditor({ history: withReferences(editor().history) })
    return true
  } catch (error) {
    showEditorRefusal('Open in place', wordsOf(error))
    return false
  }
}

/** Read those anew that have changed on disk. */
export function refreshReferences(onDisk: Dict<string | null>): void {
  for (const [id, body] of editor().bodies) {
    const hash = lookup(onDisk, id)
    if (hash && hash !== body.hash) void load(id)
  }
}

/** Where a behavior was opened from. */
export interface Referrer {
  readonly id: string
  readonly name: string
  readonly node: string
}

function keyOf(id: string): string {
  return `flexcell.from.${id}`
}

/** Remember that `id` is opened from a node here, so that its page leads back. */
export function rememberReferrer(id: string, node: string): void {
  const { id: from } = editor()
  const name = draftOf(editor()).document?.name || nameOfPath(from)
  try {
    sessionStorage.setItem(keyOf(id), JSON.stringify({ id: from, name, node } satisfies Referrer))
  } catch {
    // A browser that keeps nothing: its own way back is left.
  }
}

export function referrerOf(id: string): Referrer | undefined {
  try {
    const kept = JSON.parse(sessionStorage.getItem(keyOf(id)) ?? 'null') as Partial<Referrer> | null
    if (typeof kept?.id !== 'string' || typeof kept.name !== 'string' || typeof kept.node !== 'string') return undefined
    return { id: kept.id, name: kept.name, node: kept.node }
  } catch {
    return undefined
  }
}

/** What the editor holds: the document's history, what is chosen and shown, and what the server last refused. */
import type { MergeSides } from '../../api/documents'
import type { CatalogueBody, ConflictBody } from '../../api/types'
import { newHistory, presentOf, type History } from '../../document/editing/history'
import type { EdgeId } from '../../document/edgeId'
import type { Edit } from '../../document/editing/edits'
import { nodeOf, ROOT, type Draft, type EditNode } from '../../document/editing/model'
import { withEdits } from '../../document/editing/optimisticEdits'
import { expansionOf } from '../../document/editing/expansion'
import type { Point } from '../../document/geometry'
import { pageStore } from '../../api/pageStore'

/** Something to add, asked for by typing. */
export interface AddRequest {
  /** The container it goes into. */
  readonly parent: string
  /** Connect this outcome with it: from a port, or on an arrow that it is put on. */
  readonly from?: { readonly path: string; readonly outcome: string; readonly isInsert?: boolean }
  /** Where on the container's canvas it goes; laid out by itself without. */
  readonly at?: Point
  /** Where on the screen the palette opens. */
  readonly screen?: Point
}

export type PaletteRequest =
  | ({ readonly kind: 'add' } & AddRequest)
  | { readonly kind: 'connect'; readonly path: string }
  | { readonly kind: 'replace'; readonly paths: readonly string[] }

/** The inside of a behavior that is referred to, as its file was. */
export interface ReferredBody {
  readonly hash: string
  readonly root: EditNode
}

export interface Notice {
  readonly what: string
  readonly message: string
  readonly hint: string
  readonly tone: 'refused' | 'done'
}

export type SideTab = 'node' | 'document' | 'problems'

export interface EditorState {
  readonly id: string
  readonly phase: 'loading' | 'ready' | 'failed'
  readonly problem: string
  /** The file as it is on disk, as far as this page knows. */
  readonly base: { readonly text: string; readonly hash: string }
  readonly history: History
  /** Edits that are shown already and on their way to the server. */
  readonly unwritten: readonly (readonly Edit[])[]
  readonly catalogue: CatalogueBody | undefined
  /** Of the document's own cell by kind; undefined where it names none or they are not known yet. */
  readonly names: CatalogueBody['names'] | undefined
  /** The cell that they are of, also while they are on their way; empty for none, undefined where they must be asked for. */
  readonly namesOf: string | undefined
  /** Behaviors that are referred to, and whose insides were opened here. */
  readonly bodies: ReadonlyMap<string, ReferredBody>
  /** Where in their list the problem is that was gone to last; -1 for none. */
  readonly problemAt: number
  /** The container whose inside fills the canvas. */
  readonly scope: string
  /** Paths of the chosen nodes, the one chosen last at the end. */
  readonly selection: readonly string[]
  readonly arrow: EdgeId | undefined
  /** Containers opened and closed by hand. */
  readonly opened: ReadonlyMap<string, boolean>
  /** Containers that were open by themselves when what fills the canvas was drawn first. */
  readonly keptOpen: ReadonlySet<string>
  readonly isBusy: boolean
  readonly notice: Notice | undefined
  /** What a save has met that is for a person to decide. */
  readonly conflict: ConflictBody | undefined
  /** The sides that were chosen for its conflicts, by path and field. */
  readonly sides: MergeSides
  readonly isComparing: boolean
  readonly palette: PaletteRequest | undefined
  /** Where on the screen the menu of the selected nodes is open. */
  readonly menu: Point | undefined
  readonly isTextShown: boolean
  readonly renaming: string | undefined
  readonly tab: SideTab
  /** A node to bring into view; a new object asks anew. */
  readonly shown: { readonly path: string } | undefined
  /** A place in the text to go to; a new object asks anew. */
  readonly place: { readonly line: number; readonly column: number } | undefined
  /** The draft was found in this browser from an earlier visit. */
  readonly isRestored: boolean
  /** The file changed on disk since it was read. */
  readonly isOutdated: boolean
}

const NOTHING: Draft = {
  text: '',
  root: undefined,
  hash: '',
  findings: [],
  isChecked: true,
  targets: [],
  areTargetsKnown: true,
  isStale: false,
  document: undefined,
}

export function blank(id: string): EditorState {
  return {
    id,
    phase: 'loading',
    problem: '',
    base: { text: '', hash: '' },
    history: newHistory(NOTHING),
    unwritten: [],
    catalogue: undefined,
    names: undefined,
    namesOf: undefined,
    bodies: new Map(),
    problemAt: -1,
    scope: ROOT,
    selection: [],
    arrow: undefined,
    opened: new Map(),
    keptOpen: new Set(),
    isBusy: false,
    notice: undefined,
    conflict: undefined,
    sides: {},
    isComparing: false,
    palette: undefined,
    menu: undefined,
    isTextShown: false,
    renaming: undefined,
    tab: 'node',
    shown: undefined,
    place: undefined,
    isRestored: false,
    isOutdated: false,
  }
}

export const useEditor = pageStore<EditorState>(() => blank(''))

export const editor = useEditor.getState

export function setEditor(change: Partial<EditorState>): void {
  useEditor.setState(change)
}

/** Is the inside of a container shown on the canvas? */
export function isOpenNow(state: EditorState, path: string): boolean {
  const scope = scopeOf(state)
  return scope ? expansionOf(scope, state.opened, state.keptOpen)(path) : false
}

export function draftOf(state: EditorState): Draft {
  return presentOf(state.history).draft
}

type Unwritten = EditorState['unwritten']

/** Of each graph the newest one that is shown in its place. */
const edited = new WeakMap<EditNode, { readonly unwritten: Unwritten; readonly made: EditNode }>()

/** The graph as it is shown: with what is not written yet. */
export function rootOf(state: EditorState): EditNode | undefined {
  const { root } = draftOf(state)
  const { unwritten } = state
  if (!root || unwritten.length === 0) return root
  const known = edited.get(root)
  if (known?.unwritten === unwritten) return known.made
  // What an earlier one made impossible is left out, as the server will refuse it.
  const made = unwritten.reduce((now, edits) => withEdits(now, edits) ?? now, root)
  edited.set(root, { unwritten, made })
  return made
}

export function isDirty(state: EditorState): boolean {
  return state.phase === 'ready' && draftOf(state).text !== state.base.text
}

/** The container that fills the canvas; the root where what was shown has gone. */
export function scopeOf(state: EditorState): EditNode | undefined {
  const root = rootOf(state)
  return nodeOf(root, state.scope) ?? root
}

/** The node that was chosen last. */
export function chosenOf(state: EditorState): EditNode | undefined {
  return nodeOf(rootOf(state), state.selection.at(-1) ?? '')
}

export function showEditorRefusal(what: string, message: string, hint = ''): void {
  setEditor({ notice: { what, message, hint, tone: 'refused' } })
}

export function showEditorNotice(message: string): void {
  setEditor({ notice: { what: '', message, hint: '', tone: 'done' } })
}

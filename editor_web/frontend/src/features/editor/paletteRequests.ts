/** Opening the palettes: what to add or connect, and where. */
import { edgeOf, sourceOf } from '../../document/edgeId'
import { holderOf, isForeign, isHolder, isTreePart, nodeOf, type EditNode } from '../../document/editing/model'
import type { Point } from '../../document/geometry'
import { parentPath } from '../../document/path'
import { chosenOf, editor, isOpenNow, showEditorRefusal, rootOf, scopeOf, setEditor } from './store'

/** Where something new goes: into the selected container where it is open or empty, else beside the selected node; else into what fills the canvas. */
export function placeForNew(): EditNode | undefined {
  const state = editor()
  const root = rootOf(state)
  const chosen = chosenOf(state)
  if (!root) return undefined
  const isClosed = chosen && chosen.children.length > 0 && !isTreePart(chosen.kind) && !isOpenNow(state, chosen.path)
  const from = chosen ? (isClosed ? parentPath(chosen.path) : chosen.path) : state.scope
  return holderOf(root, from) ?? holderOf(root, scopeOf(state)?.path ?? '') ?? topOf(scopeOf(state))
}

/** What stands on top of a tree takes what is added to the tree. */
function topOf(scope: EditNode | undefined): EditNode | undefined {
  const top = scope?.kind === 'tree' ? scope.children[0] : undefined
  return top && isHolder(top) ? top : undefined
}

/** Ask what to add. */
export function openAddPalette(screen?: Point, at?: Point): void {
  const parent = placeForNew()
  if (!parent) {
    showEditorRefusal('Add', 'nothing can be put in here', 'Select a container.')
    return
  }
  setEditor({ palette: { kind: 'add', parent: parent.path, ...(screen ? { screen } : {}), ...(at ? { at } : {}) } })
}

/** Ask what to put on an arrow. */
export function openInsertPalette(arrow: string, screen?: Point): void {
  const edge = edgeOf(arrow)
  if (!edge) return
  setEditor({
    palette: {
      kind: 'add',
      parent: edge.machine,
      from: { path: sourceOf(edge), outcome: edge.outcome, isInsert: true },
      ...(screen ? { screen } : {}),
    },
  })
}

/** Ask where a port leads: what is there already, an outcome, or something new. */
export function openPortPalette(path: string, outcome: string, screen?: Point, at?: Point): void {
  setEditor({
    palette: {
      kind: 'add',
      parent: parentPath(path),
      from: { path, outcome },
      ...(screen ? { screen } : {}),
      ...(at ? { at } : {}),
    },
  })
}

/** Ask which outcome of the selected node to connect. */
export function openConnectPalette(): void {
  const root = rootOf(editor())
  const chosen = chosenOf(editor())
  const parent = chosen && root && nodeOf(root, parentPath(chosen.path))
  if (!chosen || !root || !parent || isForeign(root, chosen.path)) {
    showEditorRefusal('Connect', 'no node is selected', 'Select a node inside a machine.')
    return
  }
  setEditor({ palette: { kind: 'connect', path: chosen.path } })
}

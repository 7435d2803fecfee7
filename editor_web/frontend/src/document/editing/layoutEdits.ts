/** Edits of positions and of all notes, which mean nothing to a run: the page does them itself, and the server writes them. Pure. */
import { lookup } from '../dict'
import { withCanvasNote } from './canvasNotes'
import type { Edit } from './edits'
import { nodeOf, withNode, type EditNode } from './model'

/** Are these all edits of positions or notes? */
export function areOfLayout(edits: readonly Edit[]): boolean {
  return edits.length > 0 && edits.every(isOfLayout)
}

function isOfLayout(edit: Edit): boolean {
  return edit.edit === 'set_positions' || edit.edit === 'set_canvas_note' || (edit.edit === 'set_field' && edit.field === 'notes')
}

/** The graph with edits of positions and notes; nodes that do not change stay the same objects. */
export function withLayout(root: EditNode, edits: readonly Edit[]): EditNode {
  return edits.reduce((now, edit) => {
    if (edit.edit === 'set_positions')
      return Object.keys(edit.positions).reduce((graph, path) => {
        const position = lookup(edit.positions, path) ?? null
        return changed(graph, path, { position })
      }, now)
    if (edit.edit === 'set_canvas_note') return withCanvasNote(now, edit, edit.note)
    if (edit.edit !== 'set_field') return now
    return changed(now, edit.path, { notes: typeof edit.value === 'string' ? edit.value : '' })
  }, root)
}

function changed(root: EditNode, path: string, change: Partial<EditNode>): EditNode {
  const before = nodeOf(root, path)
  return before ? withNode(root, path, { ...before, ...change }) : root
}

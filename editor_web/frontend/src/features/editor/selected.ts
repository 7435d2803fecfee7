/** The selected nodes, as actions mean them. */
import { isForeign, ROOT } from '../../document/editing/model'
import { editor, rootOf, showEditorRefusal } from './store'

/** Paths of the chosen nodes without those that are inside another chosen one. */
export function outermost(): readonly string[] {
  const { selection } = editor()
  return selection.filter((path) => path !== ROOT && !selection.some((other) => path.startsWith(`${other}/`)))
}

/** The paths that can be changed here; what is inside another document cannot. */
export function own(paths: readonly string[], what: string): readonly string[] {
  const root = rootOf(editor())
  const mine = root ? paths.filter((path) => !isForeign(root, path)) : []
  if (mine.length < paths.length) showEditorRefusal(what, 'this is part of another behavior', 'Open that behavior and change it there.')
  else if (paths.length === 0) showEditorRefusal(what, 'nothing is selected', 'Select nodes on the canvas first.')
  return mine
}

/** Disable the selected nodes, or enable them where all are disabled. */
import { disabling } from '../../document/editing/disabling'
import { setField } from '../../document/editing/edits'
import { nameOfPath } from '../../document/path'
import { perform } from './apply'
import { outermost } from './selected'
import { editor, rootOf, showEditorRefusal } from './store'

export async function toggleDisabled(paths: readonly string[] = outermost()): Promise<void> {
  const root = rootOf(editor())
  if (!root) return
  const { edits, isEnabling, obstacle } = disabling(root, paths)
  const verb = isEnabling ? 'Enable' : 'Disable'
  if (obstacle) showEditorRefusal(verb, obstacle)
  else await perform(`${verb} ${paths.length === 1 ? nameOfPath(paths[0] ?? '') : `${paths.length} nodes`}`, edits)
}

/** Say with which outcome a disabled node is passed over. */
export async function passWith(path: string, outcome: string): Promise<void> {
  await perform(`Pass over ${nameOfPath(path)} with ${outcome}`, [setField(path, 'disabled', outcome)])
}

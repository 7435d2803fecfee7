/** Giving the selected nodes another type in place; what that would lose is shown before. */
import { wordsOf } from '../../api/client'
import { documents } from '../../api/documents'
import { pageStore } from '../../api/pageStore'
import type { TypeLoss } from '../../api/types'
import type { Edit } from '../../document/editing/edits'
import { nodeOf, ROOT } from '../../document/editing/model'
import { nameOfPath } from '../../document/path'
import { choose, focusNode, type Addition } from './actions'
import { inTurn, perform } from './apply'
import { own } from './selected'
import { draftOf, editor, rootOf, setEditor, showEditorRefusal } from './store'

/** A replacement that waits until its losses are accepted. */
export interface PendingReplacement {
  readonly paths: readonly string[]
  readonly to: Addition
  readonly losses: readonly TypeLoss[]
}

export const usePendingReplacement = pageStore<{ readonly pending: PendingReplacement | undefined }>(() => ({ pending: undefined }))

export function dropReplacement(): void {
  usePendingReplacement.setState({ pending: undefined })
}

/** Of some nodes those that can be changed here, without what is inside another of them. */
function replaceable(paths: readonly string[]): readonly string[] {
  return own(
    paths.filter((path) => !paths.some((other) => path.startsWith(`${other}/`))),
    'Replace',
  )
}

/** Ask what nodes are to be instead: the selected ones, else what fills the canvas. */
export function openReplacePalette(asked?: readonly string[]): void {
  const { selection, scope } = editor()
  const paths = replaceable(asked ?? (selection.length > 0 ? selection : [scope || ROOT]))
  if (paths.length > 0) setEditor({ palette: { kind: 'replace', paths } })
}

/** Replace the type of nodes at once where nothing is lost, else after the losses were shown. */
export async function replaceType(paths: readonly string[], to: Addition): Promise<void> {
  const { id } = editor()
  try {
    const text = () => draftOf(editor()).text
    const answer = await inTurn(() =>
      documents.edit(id, text(), [replacement(paths, to, [])], { check: false, graph: draftOf(editor()).hash || null }),
    )
    if (editor().id !== id) return
    const losses = answer.refused?.losses ?? []
    if (losses.length > 0) usePendingReplacement.setState({ pending: { paths, to, losses } })
    else await performReplacement({ paths, to, losses })
  } catch (error) {
    showEditorRefusal('Replace', wordsOf(error))
  }
}

export async function performReplacement({ paths, to, losses }: PendingReplacement): Promise<void> {
  dropReplacement()
  const what = paths.length === 1 ? nameOfPath(paths[0] ?? '') : `${paths.length} nodes`
  const answer = await perform(`Replace ${what} by ${to.runs ?? to.kind}`, [replacement(paths, to, losses)])
  const made = answer?.changed.filter((path) => nodeOf(rootOf(editor()), path)) ?? []
  if (made.length === 0) return
  choose(made)
  focusNode(made[0] ?? '')
}

function replacement(paths: readonly string[], to: Addition, accepted: readonly TypeLoss[]): Edit {
  return { edit: 'replace_type', paths, kind: to.kind, ...(to.runs ? { runs: to.runs } : {}), accepted }
}

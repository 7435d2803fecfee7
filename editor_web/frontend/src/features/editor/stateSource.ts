/** Which state's source is shown. */
import { pageStore } from '../../api/pageStore'
import type { EditNode } from '../../document/editing/model'
import { showEditorRefusal } from './store'

export const useShownSource = pageStore<{ readonly state: string | undefined }>(() => ({ state: undefined }))

export function showSource(state: string): void {
  useShownSource.setState({ state })
}

export function hideSource(): void {
  useShownSource.setState({ state: undefined })
}

export function showSourceOf(node: EditNode | undefined): void {
  if (node?.state) showSource(node.state)
  else showEditorRefusal('Source', 'this node runs no state', 'Select a state; a behavior opens with Enter.')
}

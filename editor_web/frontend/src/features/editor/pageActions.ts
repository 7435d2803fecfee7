/** What the page around the editor does for it, and going to other behaviors. */
import { pageStore } from '../../api/pageStore'
import type { StartHere } from '../../api/startHere'
import { rememberReferrer } from './references'

/** What the page does for the editor: running, fitting, showing. */
export interface PageActions {
  /** Save, check and go to the page of the run; there ask to start at a node or to run to one. */
  readonly run: (here?: Pick<StartHere, 'path' | 'kind'>) => void
  readonly fit: () => void
  readonly zoom: (factor: number) => void
  /** Open another behavior in the editor. */
  readonly open: (id: string, node: string) => void
}

const NONE: PageActions = { run: () => undefined, fit: () => undefined, zoom: () => undefined, open: () => undefined }
const actions = pageStore(() => NONE)

/** Open another behavior; the draft of this one is kept. */
export function openOther(id: string, node = ''): void {
  pageActions().open(id, node)
}

/** Open a behavior that a node here refers to; its page leads back to the node. */
export function openReferred(id: string, from: string, node = ''): void {
  rememberReferrer(id, from)
  openOther(id, node)
}

export function setPageActions(given: PageActions): void {
  actions.setState(given, true)
}

export function pageActions(): PageActions {
  return actions.getState()
}

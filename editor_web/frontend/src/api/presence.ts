/** Who has the page open: what this page tells of itself, and what the others show. */
import { useShallow } from 'zustand/react/shallow'
import { useLive } from './liveStore'
import { pageStore } from './pageStore'
import type { Presence, ShowPresence } from './types'

const NAME = 'flexcell.name'

/** What this page shows to the others; without a name it has the one that the server gives. */
export type OwnPresence = Required<Omit<ShowPresence, 'k'>>

export const useOwnPresence = pageStore<OwnPresence>(() => ({
  name: localStorage.getItem(NAME) ?? '',
  document: '',
  node: '',
  edits: false,
}))

/** Let the others know that this page shows another behavior, or another node of it. */
export function showPresence(shown: Partial<Omit<OwnPresence, 'name'>>): void {
  useOwnPresence.setState(shown)
}

/** Call oneself so from now on, in this browser. */
export function rename(name: string): void {
  localStorage.setItem(NAME, name.trim())
  useOwnPresence.setState({ name: name.trim() })
}

/** The other pages that have a node selected, or one inside where the node stands for what is inside. */
export function useOthersAt(document: string, node: string, isFolded: boolean): readonly Presence[] {
  return useLive(
    useShallow((s) =>
      s.present.filter(
        (each) =>
          each.page !== s.page && each.document === document && (each.node === node || (isFolded && each.node.startsWith(`${node}/`))),
      ),
    ),
  )
}

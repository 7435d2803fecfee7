/** The draft, kept in this browser until it is saved: a closed tab or a crash loses nothing. */
import { pageStore } from '../../api/pageStore'
import { Pause } from '../../document/pause'
import { draftOf, editor, isDirty } from './store'

export interface StoredDraft {
  readonly text: string
  /** Hash of the file that the draft was made from. */
  readonly base: string
  readonly baseText: string
}

const PAUSE_MS = 300

const pause = pageStore(
  () => new Pause(),
  (ended) => ended.cancel(),
)

function keyOf(id: string): string {
  return `flexcell.draft.${id}`
}

/** Keep the present draft, soon; nothing is kept of what is saved. */
export function storeDraft(): void {
  pause.getState().later(PAUSE_MS, storeDraftNow)
}

export function storeDraftNow(): void {
  pause.getState().cancel()
  const state = editor()
  if (state.phase !== 'ready') return
  try {
    if (!isDirty(state)) localStorage.removeItem(keyOf(state.id))
    else {
      const kept: StoredDraft = { text: draftOf(state).text, base: state.base.hash, baseText: state.base.text }
      localStorage.setItem(keyOf(state.id), JSON.stringify(kept))
    }
  } catch {
    // A browser that keeps nothing, or has no room: the draft lives as long as the page.
  }
}

export function storedDraft(id: string): StoredDraft | undefined {
  try {
    const kept = JSON.parse(localStorage.getItem(keyOf(id)) ?? 'null') as Partial<StoredDraft> | null
    if (typeof kept?.text !== 'string' || typeof kept.base !== 'string' || typeof kept.baseText !== 'string') return undefined
    return { text: kept.text, base: kept.base, baseText: kept.baseText }
  } catch {
    return undefined
  }
}

export function deleteStoredDraft(id: string): void {
  try {
    localStorage.removeItem(keyOf(id))
  } catch {
    // Nothing was kept.
  }
}

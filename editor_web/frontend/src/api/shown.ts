/** What the 3D view of this page shows: kept in the browser, told to the server over the live connection. */
import { create } from 'zustand'
import type { Show } from './types'

export type Group = Show['groups'][number]

export const GROUPS: readonly Group[] = ['voxels', 'ways', 'obstacles', 'people', 'cameras', 'detections', 'frames']
const AT_FIRST: readonly Group[] = ['voxels', 'ways', 'obstacles', 'people', 'detections']
const KEPT = 'flexcell.shown'

/** What this page calls itself in the path of its 3D view; another page shows what it wants. */
export const PAGE = Array.from(crypto.getRandomValues(new Uint32Array(3)), (part) => part.toString(36)).join('')

export const useShown = create<{ readonly groups: readonly Group[] }>(() => ({ groups: kept() }))

/** Show or hide one group. */
export function setShown(group: Group, isShown: boolean): void {
  const others = useShown.getState().groups.filter((each) => each !== group)
  const groups = isShown ? [...others, group] : others
  localStorage.setItem(KEPT, JSON.stringify(groups))
  useShown.setState({ groups })
}

function kept(): readonly Group[] {
  try {
    const groups: unknown = JSON.parse(localStorage.getItem(KEPT) ?? 'null')
    return Array.isArray(groups) ? GROUPS.filter((group) => groups.includes(group)) : AT_FIRST
  } catch {
    // What somebody else has written there is no reason not to start.
    return AT_FIRST
  }
}

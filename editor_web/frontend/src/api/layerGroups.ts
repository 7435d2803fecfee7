/** What the 3D view of this page shows: kept in the browser, told to the server over the live connection. */
import type { ShowLayers } from './types'
import { pageStore } from './pageStore'

export type LayerGroup = ShowLayers['groups'][number]

export const LAYER_GROUPS: readonly LayerGroup[] = [
  'voxels',
  'paths',
  'obstacles',
  'people',
  'cameras',
  'detections',
  'frames',
  'commanded',
]
const AT_FIRST: readonly LayerGroup[] = ['voxels', 'paths', 'obstacles', 'people', 'detections']
const KEPT = 'flexcell.layers'

/** What this page calls itself in the path of its 3D view; another page shows what it wants. */
export const PAGE = Array.from(crypto.getRandomValues(new Uint32Array(3)), (part) => part.toString(36)).join('')

export const useShownLayers = pageStore<{ readonly groups: readonly LayerGroup[] }>(() => ({ groups: kept() }))

/** Show or hide one group. */
export function setLayerShown(group: LayerGroup, isShown: boolean): void {
  const others = useShownLayers.getState().groups.filter((each) => each !== group)
  const groups = isShown ? [...others, group] : others
  localStorage.setItem(KEPT, JSON.stringify(groups))
  useShownLayers.setState({ groups })
}

function kept(): readonly LayerGroup[] {
  try {
    const groups: unknown = JSON.parse(localStorage.getItem(KEPT) ?? 'null')
    return Array.isArray(groups) ? LAYER_GROUPS.filter((group) => groups.includes(group)) : AT_FIRST
  } catch {
    // What somebody else has written there is no reason not to start.
    return AT_FIRST
  }
}

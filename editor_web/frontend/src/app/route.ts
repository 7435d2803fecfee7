/** Which page an address means, and going to another one without loading. */
import { useSyncExternalStore } from 'react'
import { momentText } from '../document/moment'
import { addressOf, decoded, partsOfPath, pathOfAddress } from '../document/path'

export type Route =
  | { readonly page: 'home' }
  | { readonly page: 'behavior'; readonly id: string }
  | { readonly page: 'run'; readonly id: string }
  | { readonly page: 'runs' }
  | { readonly page: 'beside'; readonly left: string; readonly right: string }
  | { readonly page: 'compare'; readonly left: string; readonly right: string }
  | { readonly page: 'trend'; readonly behavior: string }
  | { readonly page: 'edit'; readonly id: string }
  | { readonly page: 'past' }
  | { readonly page: 'teach' }
  | { readonly page: 'recording'; readonly id: string }
  | { readonly page: 'cell'; readonly item: string }
  | { readonly page: 'sweeps' }
  | { readonly page: 'sweep'; readonly id: string }

/** Read an address; what it does not know is the home page. */
export function routeOf(pathname: string): Route {
  const [, page, ...rest] = partsOfPath(pathname)
  const id = pathOfAddress(rest)
  if (page === 'behaviors' && id) return { page: 'behavior', id }
  if (page === 'runs') return id ? { page: 'run', id } : { page: 'runs' }
  if (page === 'beside') return { page: 'beside', left: decoded(rest[0] ?? ''), right: decoded(rest[1] ?? '') }
  if (page === 'compare') return { page: 'compare', left: decoded(rest[0] ?? ''), right: decoded(rest[1] ?? '') }
  if (page === 'trends' && id) return { page: 'trend', behavior: id }
  if (page === 'edit' && id) return { page: 'edit', id }
  if (page === 'past') return { page: 'past' }
  if (page === 'teach') return { page: 'teach' }
  if (page === 'recordings' && id) return { page: 'recording', id }
  // Not `/cell`, below which the server has the 3D view.
  if (page === 'workcell') return { page: 'cell', item: id }
  if (page === 'sweeps') return id ? { page: 'sweep', id } : { page: 'sweeps' }
  return { page: 'home' }
}

export function behaviorHref(id: string): string {
  return `/behaviors/${addressOf(id)}`
}

export const CELL_HREF = '/workcell'

/** The cell, at one of its items where one is given, `robots/left`, and at a topic that tells of it. */
export function cellHref(item = '', topic = ''): string {
  return item ? `${CELL_HREF}/${addressOf(item)}${topic && `#${topic}`}` : CELL_HREF
}

export const TEACH_HREF = '/teach'

/** The editor, at a node where one is given. */
export function editHref(id: string, node = ''): string {
  return `/edit/${addressOf(id)}${node ? `#${node}` : ''}`
}

export function runHref(id: string): string {
  return `/runs/${encodeURIComponent(id)}`
}

export const RUNS_HREF = '/runs'

/** Two runs side by side. */
export function sideBySideHref(left: string, right: string): string {
  return `/beside/${encodeURIComponent(left)}/${encodeURIComponent(right)}`
}

export const PAST_HREF = '/past'

export function recordingHref(path: string): string {
  return `/recordings/${addressOf(path)}`
}

/** In the place of the left run: the last run of the same behavior before the right one that succeeded. */
export const LAST_GOOD = 'last-good'

/** Two past runs compared, at a visit where one is given. */
export function compareHref(left: string, right: string, place = ''): string {
  return `/compare/${encodeURIComponent(left)}/${encodeURIComponent(right)}${place ? `#${place}` : ''}`
}

/** The last runs of a behavior, by its name. */
export function trendHref(behavior: string): string {
  return `/trends/${addressOf(behavior)}`
}

/** Whether a name is the path of a recording, and not the id of a run. */
export function isRecordingName(name: string): boolean {
  return /\.mcap(\.part)?$/.test(name)
}

/** A run, or a recording by its path, at a time of it and with a node selected where these are given. */
export function recordedHref(name: string, timeS?: number, path?: string): string {
  const page = isRecordingName(name) ? recordingHref(name) : runHref(name)
  const at = momentText(timeS, path)
  return at ? `${page}#${at}` : page
}

export const SWEEPS_HREF = '/sweeps'

/** A sweep, at one of its runs where one is given. */
export function sweepHref(id: string, run?: number): string {
  return `/sweeps/${addressOf(id)}${run === undefined ? '' : `#${run}`}`
}

const listeners = new Set<() => void>()

export function goTo(href: string): void {
  if (href !== location.pathname) history.pushState(null, '', href)
  listeners.forEach((listener) => listener())
}

/** The same page under another address. */
export function replaceWith(href: string): void {
  history.replaceState(null, '', href)
  listeners.forEach((listener) => listener())
}

function subscribe(listener: () => void): () => void {
  listeners.add(listener)
  addEventListener('popstate', listener)
  return () => {
    listeners.delete(listener)
    removeEventListener('popstate', listener)
  }
}

export function useRoute(): Route {
  return routeOf(useSyncExternalStore(subscribe, () => location.pathname))
}

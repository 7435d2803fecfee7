/** Watches: lists of them, and what was kept of them. Pure. */
import type { Watch } from '../api/types'
import type { Dict } from './dict'

export type WatchesByBehavior = Dict<readonly Watch[]>

/** The most that a server evaluates for one page. */
const MOST = 40

export function isSameWatch(one: Watch, other: Watch): boolean {
  return one.expression === other.expression && (one.path ?? '') === (other.path ?? '')
}

/** The list with one more, unless it is there, or there are too many. */
export function addWatch(all: readonly Watch[], watch: Watch): readonly Watch[] {
  return all.length >= MOST || all.some((each) => isSameWatch(each, watch)) ? all : [...all, watch]
}

/** Those of a kept text that are watches. */
export function readWatches(kept: unknown): WatchesByBehavior {
  if (typeof kept !== 'object' || kept === null) return {}
  return Object.fromEntries(
    Object.entries(kept).map(([behavior, all]) => [behavior, Array.isArray(all) ? all.filter(isWatch).slice(0, MOST) : []]),
  )
}

function isWatch(each: unknown): each is Watch {
  return typeof each === 'object' && each !== null && 'expression' in each && typeof each.expression === 'string'
}

/** The userdata of a run as it is shown: scopes merged from what has changed, searched, named. Pure. */
import type { ScopeView, UserdataRecord } from '../api/types'
import type { Dict } from './dict'
import { inShort } from './values'

export type Scopes = Dict<ScopeView>

/** Scopes with what has changed in them; null takes one away. */
export function withChanges(before: Scopes, changes: Dict<ScopeView | null>, isAll: boolean): Scopes {
  const merged = isAll ? { ...changes } : { ...before, ...changes }
  return Object.fromEntries(Object.entries(merged).filter((entry): entry is [string, ScopeView] => entry[1] !== null))
}

export interface ScopeShown {
  readonly path: string
  readonly name: string
  readonly isOpen: boolean
  readonly lines: readonly (UserdataRecord & { readonly key: string })[]
}

/** The scopes that have values, or values that match; those of active containers first, each in the order of its path. */
export function shownScopes(scopes: Scopes, search: string): readonly ScopeShown[] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean)
  const shown = Object.entries(scopes).map(([path, scope]) => ({
    path,
    name: scopeName(path),
    isOpen: scope.is_open,
    lines: Object.entries(scope.values)
      .map(([key, line]) => ({ key, ...line }))
      .filter((line) => {
        const text = `${path} ${line.key} ${inShort(line.value)} ${line.by}`.toLowerCase()
        return words.every((word) => text.includes(word))
      }),
  }))
  const withLines = shown.filter((scope) => scope.lines.length > 0)
  return withLines.toSorted((a, b) => Number(b.isOpen) - Number(a.isOpen) || (a.path < b.path ? -1 : 1))
}

/** The names that an expression can use: parameters, and the keys of all scopes. */
export function namesIn(scopes: Scopes, parameters: readonly { readonly name: string }[]): readonly string[] {
  const keys = Object.values(scopes).flatMap((scope) => Object.keys(scope.values))
  return [...new Set([...parameters.map((each) => each.name), ...keys])].toSorted()
}

/** The container of a scope: `root/loop` of `root/loop#3`, `root/both/left` of `root/both/left*`. */
export function containerOf(path: string): string {
  return path.split('#')[0]?.replace(/\*$/, '') ?? path
}

/** `Behavior`, `root/inner`, `root/loop, round 3`, `root/both/left, not merged yet`. */
export function scopeName(path: string): string {
  if (path === '') return 'Behavior'
  const [container, round] = path.split('#')
  if (round !== undefined) return `${container}, round ${Number(round) + 1}`
  return path.endsWith('*') ? `${path.slice(0, -1)}, not merged yet` : path
}

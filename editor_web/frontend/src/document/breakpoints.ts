/** Breakpoints: which nodes they are about, editing a list of them, saying them in words. Pure. */
import type { Breakpoint } from '../api/types'

/** A breakpoint with everything that the wire leaves out. */
export type CompleteBreakpoint = Required<Breakpoint>

/** Does a breakpoint's path, which may hold `*` and `?`, mean this node? */
export function matches(pattern: string, path: string): boolean {
  if (pattern === path) return true
  if (!/[*?]/.test(pattern)) return false
  const source = pattern
    .replace(/[.+^${}()|[\]\\]/g, '\\$&')
    .replace(/\*/g, '.*')
    .replace(/\?/g, '.')
  return new RegExp(`^${source}$`, 's').test(path)
}

/** With everything that may be left out filled in. */
export function completed(given: Breakpoint): CompleteBreakpoint {
  return {
    path: given.path,
    when: given.when ?? 'before',
    if: given.if ?? null,
    hits: given.hits ?? 1,
    outcomes: given.outcomes ?? [],
    enabled: given.enabled ?? true,
    once: given.once ?? false,
  }
}

type Place = Pick<CompleteBreakpoint, 'path' | 'when'>

function isAt(each: CompleteBreakpoint, place: Place): boolean {
  return each.path === place.path && each.when === place.when
}

/** The list with or without a breakpoint at this place. */
export function toggled(list: readonly CompleteBreakpoint[], place: Place, isSet: boolean): readonly CompleteBreakpoint[] {
  const others = list.filter((each) => !isAt(each, place))
  return isSet ? [...others, completed(place)] : others
}

/** The list with this breakpoint in the place of the one that was there. */
export function replaced(list: readonly CompleteBreakpoint[], fresh: CompleteBreakpoint): readonly CompleteBreakpoint[] {
  const known = list.some((each) => isAt(each, fresh))
  return known ? list.map((each) => (isAt(each, fresh) ? fresh : each)) : [...list, fresh]
}

/** `before, if tries > 1, from the 3rd time on`. */
export function breakpointWords({ when, if: condition, hits, outcomes, enabled, once }: CompleteBreakpoint): string {
  const parts: string[] = [when]
  if (outcomes.length > 0) parts.push(`with ${outcomes.join(' or ')}`)
  if (condition) parts.push(`if ${condition}`)
  if (hits > 1) parts.push(`from time ${hits} on`)
  if (once) parts.push('once')
  if (!enabled) parts.push('off')
  return parts.join(', ')
}

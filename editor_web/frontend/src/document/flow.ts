/** The order in which a machine is read: as its transitions lead on, the first outcome of each node first. Pure. */
import type { GraphTransition } from '../api/types'
import { leadingOn, type Targets } from './loops'

export interface Flow {
  /** The names of the children, each before those that it leads to, but for the way back of a loop. */
  readonly order: readonly string[]
  /** The children and targets outside as they stand over one another, from the top: each below what leads to it first. */
  readonly downwards: readonly string[]
  /** The children that no transition leads to or from: they stand aside, so that adding one moves nothing. */
  readonly loose: readonly string[]
}

/** `names` are those of the children as the document has them, `initial` is where it begins. */
export function flowOf(names: readonly string[], transitions: readonly GraphTransition[], initial: string | null): Flow {
  const inside = new Set(names)
  const next = new Map(names.map((name): [string, string[]] => [name, []]))
  const sources = new Set<string>()
  const targets = new Set<string>()
  for (const { source, target } of transitions) {
    sources.add(source)
    if (source !== target) targets.add(target)
    next.get(source)?.push(target)
  }
  const first = initial !== null && inside.has(initial) ? initial : names[0]
  const loose = names.filter((name) => name !== first && !sources.has(name) && !targets.has(name))
  const aside = new Set(loose)
  const [outer, inner] = [names.filter((name) => !targets.has(name)), names.filter((name) => targets.has(name))]
  const starts = [...(first === undefined ? [] : [first]), ...[...outer, ...inner].filter((name) => !aside.has(name))]
  const forward = leadingOn(starts, next)
  const downwards = asTree(forward)
  return { order: inFlow(downwards, forward).filter((name) => inside.has(name)), downwards, loose }
}

/**
 * All nodes as a tree that is read from the top: a node hangs on the last of those that lead to it, so it stands near
 * that, and one that leads to it from further away moves nothing. Of several it is the one that is entered first.
 */
function asTree(forward: Targets): readonly string[] {
  const depths = new Map<string, number>()
  for (const name of inFlow([...forward.keys()], forward)) {
    const behind = (depths.get(name) ?? 0) + 1
    for (const target of forward.get(name) ?? []) depths.set(target, Math.max(behind, depths.get(target) ?? 0))
  }
  const parents = new Map<string, string>()
  for (const [name, targets] of forward) {
    const behind = (depths.get(name) ?? 0) + 1
    for (const target of targets) if (depths.get(target) === behind && !parents.has(target)) parents.set(target, name)
  }
  const downwards: string[] = []
  const due = [...forward.keys()].filter((name) => !parents.has(name)).toReversed()
  for (let name = due.pop(); name !== undefined; name = due.pop()) {
    const parent = name
    downwards.push(parent)
    due.push(...new Set((forward.get(parent) ?? []).filter((target) => parents.get(target) === parent).toReversed()))
  }
  return downwards
}

/** Each before those that it leads to; of those that may be next the upper one. */
function inFlow(downwards: readonly string[], forward: Targets): readonly string[] {
  const ranks = new Map(downwards.map((name, rank) => [name, rank]))
  const missing = new Map<string, number>()
  for (const targets of forward.values()) for (const target of targets) missing.set(target, (missing.get(target) ?? 0) + 1)
  const ready = downwards.filter((name) => !missing.has(name))
  const order: string[] = []
  for (let name = ready.shift(); name !== undefined; name = ready.shift()) {
    order.push(name)
    for (const target of forward.get(name) ?? []) {
      const count = (missing.get(target) ?? 0) - 1
      missing.set(target, count)
      if (count > 0) continue
      const rank = ranks.get(target) ?? 0
      const at = ready.findIndex((each) => (ranks.get(each) ?? 0) > rank)
      ready.splice(at < 0 ? ready.length : at, 0, target)
    }
  }
  return order
}

/** The order in which a machine is read: as its transitions lead on, whatever order the document has. Pure. */
import type { GraphTransition } from '../api/types'

export interface Flow {
  /** The names of the children, each before those that it leads to, but for the way back of a loop. */
  readonly order: readonly string[]
  /** The children that no transition leads to or from: they stand aside, so that adding one moves nothing. */
  readonly loose: readonly string[]
}

/** `names` are those of the children as the document has them, `initial` is where it begins. */
export function flowOf(names: readonly string[], transitions: readonly GraphTransition[], initial: string | null): Flow {
  const inside = new Set(names)
  const next = new Map(names.map((name): [string, string[]] => [name, []]))
  const joined = new Set<string>()
  for (const { source, target } of transitions) {
    joined.add(source)
    if (source !== target) joined.add(target)
    if (inside.has(target)) next.get(source)?.push(target)
  }
  const first = initial !== null && inside.has(initial) ? initial : names[0]
  const loose = names.filter((name) => name !== first && !joined.has(name))
  const seen = new Set(loose)
  const order = [...(first === undefined ? [] : [first]), ...names].flatMap((name) => after(name, next, seen))
  return { order, loose }
}

/** What follows `start`, itself first, as far as it is not seen yet. In a list, as a chain may be thousands long. */
function after(start: string, next: ReadonlyMap<string, readonly string[]>, seen: Set<string>): readonly string[] {
  if (seen.has(start)) return []
  const left: string[] = []
  const open: { readonly name: string; readonly targets: string[] }[] = []
  const enter = (name: string) => {
    seen.add(name)
    open.push({ name, targets: [...(next.get(name) ?? [])] })
  }
  enter(start)
  for (let last = open.at(-1); last; last = open.at(-1)) {
    // What is left last is read first, so the first transition is followed last.
    const target = last.targets.pop()
    if (target === undefined) {
      left.push(last.name)
      open.pop()
    } else if (!seen.has(target)) enter(target)
  }
  return left.toReversed()
}

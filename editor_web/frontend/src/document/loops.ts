/** Which transitions lead on, and which lead back in a loop. Pure. */

/** The targets of each node, in the order of its outcomes. */
export type Targets = ReadonlyMap<string, readonly string[]>

/**
 * The transitions that lead on, by the nodes in the order in which they are entered; they make no circle.
 *
 * A transition leads back where every path to its source passes its target. Where a loop is entered at several places, the
 * document decides: what leads to a later node leads on, what leads to an earlier one unless that closes a circle. So a
 * transition from a node that is added at the end of the document makes no other one lead back.
 *
 * `starts` are entered one after the other, and nothing leads on to the first of them.
 */
export function leadingOn(starts: readonly string[], next: Targets): Targets {
  const places = new Map([...next.keys()].map((name, place) => [name, place]))
  const forward = new Map<string, readonly string[]>()
  for (const start of starts) {
    if (forward.has(start)) continue
    const walk = walkFrom(start, next, new Set(forward.keys()))
    const back = isBack(walk)
    const on = new Map(walk.entered.map((name) => [name, (next.get(name) ?? []).filter((to) => to !== starts[0] && !back(name, to))]))
    for (const [name, targets] of isAcyclic(on) ? on : byDocument(on, places)) forward.set(name, targets)
  }
  return forward
}

/** What is reached from one start, as far as it was not reached before. */
interface Walk {
  readonly entered: readonly string[]
  /** The number of each node: those that a node leads to have higher ones, but for loops. */
  readonly numbers: ReadonlyMap<string, number>
  /** The nodes that lead to each node. */
  readonly before: ReadonlyMap<string, readonly string[]>
}

/** In lists, as a chain may be thousands long. */
function walkFrom(start: string, next: Targets, reached: Set<string>): Walk {
  const before = new Map<string, string[]>([[start, []]])
  const left: string[] = []
  const open = [{ name: start, targets: (next.get(start) ?? []).toReversed() }]
  for (let last = open.at(-1); last; last = open.at(-1)) {
    const target = last.targets.pop()
    if (target === undefined) {
      left.push(last.name)
      open.pop()
    } else if (!reached.has(target)) {
      const sources = before.get(target)
      if (sources) sources.push(last.name)
      else {
        before.set(target, [last.name])
        open.push({ name: target, targets: (next.get(target) ?? []).toReversed() })
      }
    }
  }
  return { entered: [...before.keys()], numbers: new Map(left.toReversed().map((name, number) => [name, number])), before }
}

/** Whether every path from the start to `source` passes `target`: it dominates it (Cooper, Harvey and Kennedy). */
function isBack({ numbers, before }: Walk): (source: string, target: string) => boolean {
  const names = [...numbers.keys()]
  const dominators = [0]
  const common = (one: number, other: number): number => {
    let [low, high] = [Math.min(one, other), Math.max(one, other)]
    while (low !== high) {
      const above = dominators[high] ?? 0
      ;[low, high] = [Math.min(low, above), Math.max(low, above)]
    }
    return low
  }
  for (let hasChanged = true; hasChanged;) {
    hasChanged = false
    names.forEach((name, number) => {
      if (number === 0) return
      const known = (before.get(name) ?? []).map((each) => numbers.get(each) ?? 0).filter((each) => dominators[each] !== undefined)
      const found = known.reduce(common)
      if (dominators[number] === found) return
      dominators[number] = found
      hasChanged = true
    })
  }
  return (source, target) => {
    // What was reached from an earlier start is never passed.
    const passed = numbers.get(target) ?? Infinity
    let number = numbers.get(source) ?? 0
    for (; number > passed; number = dominators[number] ?? 0);
    return number === passed
  }
}

/** Whether all nodes can be taken away one by one, each when nothing that is left leads to it. */
function isAcyclic(on: Targets): boolean {
  const due = new Map<string, number>()
  for (const targets of on.values()) for (const target of targets) due.set(target, (due.get(target) ?? 0) + 1)
  const free = [...on.keys()].filter((name) => !due.has(name))
  let count = 0
  for (let name = free.pop(); name !== undefined; name = free.pop()) {
    count += 1
    for (const target of on.get(name) ?? []) {
      const left = (due.get(target) ?? 0) - 1
      due.set(target, left)
      if (left === 0 && on.has(target)) free.push(target)
    }
  }
  return count === on.size
}

function byDocument(on: Targets, places: ReadonlyMap<string, number>): Targets {
  const placeOf = (name: string) => places.get(name) ?? Infinity
  const kept = new Map([...on].map(([name, targets]) => [name, new Set(targets.filter((target) => placeOf(target) > placeOf(name)))]))
  for (const name of [...on.keys()].toSorted((one, other) => placeOf(one) - placeOf(other))) {
    for (const target of on.get(name) ?? []) if (!leads(target, name, kept)) kept.get(name)?.add(target)
  }
  return new Map([...on].map(([name, targets]) => [name, targets.filter((target) => kept.get(name)?.has(target))]))
}

function leads(from: string, to: string, along: ReadonlyMap<string, ReadonlySet<string>>): boolean {
  const passed = new Set([from])
  for (const name of passed) for (const target of along.get(name) ?? []) passed.add(target)
  return passed.has(to)
}

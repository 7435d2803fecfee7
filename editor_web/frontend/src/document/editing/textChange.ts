/** Differences of texts: the one stretch that changed, and the lines that differ. Pure. */

export interface TextChange {
  readonly from: number
  readonly to: number
  readonly insert: string
}

/** The smallest single replacement that makes `after` of `before`; undefined when they are the same. */
export function changeBetween(before: string, after: string): TextChange | undefined {
  if (before === after) return undefined
  const most = Math.min(before.length, after.length)
  let start = 0
  while (start < most && before[start] === after[start]) start += 1
  let end = 0
  while (end < most - start && before[before.length - 1 - end] === after[after.length - 1 - end]) end += 1
  return { from: start, to: before.length - end, insert: after.slice(start, after.length - end) }
}

export interface LinePair {
  readonly left: string | undefined
  readonly right: string | undefined
  readonly isSame: boolean
}

const LARGEST = 4_000_000

/** Two texts line by line, side by side; what is only in one has no partner. */
export function sideBySide(left: string, right: string): readonly LinePair[] {
  const a = left.split('\n')
  const b = right.split('\n')
  let start = 0
  while (start < a.length && start < b.length && a[start] === b[start]) start += 1
  let end = 0
  while (end < a.length - start && end < b.length - start && a[a.length - 1 - end] === b[b.length - 1 - end]) end += 1
  const same = (line: string): LinePair => ({ left: line, right: line, isSame: true })
  return [
    ...a.slice(0, start).map(same),
    ...middle(a.slice(start, a.length - end), b.slice(start, b.length - end)),
    ...a.slice(a.length - end).map(same),
  ]
}

function middle(a: readonly string[], b: readonly string[]): readonly LinePair[] {
  if (a.length * b.length > LARGEST) return paired(a, b)
  const width = b.length + 1
  const longest = new Uint32Array((a.length + 1) * width)
  for (let i = a.length - 1; i >= 0; i -= 1) {
    for (let j = b.length - 1; j >= 0; j -= 1) {
      longest[i * width + j] =
        a[i] === b[j]
          ? (longest[(i + 1) * width + j + 1] ?? 0) + 1
          : Math.max(longest[(i + 1) * width + j] ?? 0, longest[i * width + j + 1] ?? 0)
    }
  }
  const pairs: LinePair[] = []
  let removed: string[] = []
  let added: string[] = []
  const flush = () => {
    pairs.push(...paired(removed, added))
    removed = []
    added = []
  }
  let [i, j] = [0, 0]
  while (i < a.length || j < b.length) {
    if (i < a.length && j < b.length && a[i] === b[j]) {
      flush()
      pairs.push({ left: a[i], right: b[j], isSame: true })
      i += 1
      j += 1
    } else if (j >= b.length || (i < a.length && (longest[(i + 1) * width + j] ?? 0) >= (longest[i * width + j + 1] ?? 0))) {
      removed.push(a[i] ?? '')
      i += 1
    } else {
      added.push(b[j] ?? '')
      j += 1
    }
  }
  flush()
  return pairs
}

function paired(a: readonly string[], b: readonly string[]): readonly LinePair[] {
  return Array.from({ length: Math.max(a.length, b.length) }, (_, index) => ({
    left: a[index],
    right: b[index],
    isSame: false,
  }))
}

/** Runs of equal lines longer than `context` on both sides are folded; `undefined` stands for a fold. */
export function folded(pairs: readonly LinePair[], context = 3): readonly (LinePair | undefined)[] {
  const near = pairs.map((_, index) => pairs.slice(Math.max(0, index - context), index + context + 1).some((pair) => !pair.isSame))
  const out: (LinePair | undefined)[] = []
  pairs.forEach((pair, index) => {
    if (near[index]) out.push(pair)
    else if (index === 0 || near[index - 1]) out.push(undefined)
  })
  return out
}

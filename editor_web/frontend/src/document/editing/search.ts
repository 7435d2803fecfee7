/** Finding by typing: every word must occur, beginnings of words count most. Pure. */

/** How well `query` fits texts, the first being the most important; undefined where it does not. */
export function fit(query: string, ...texts: readonly string[]): number | undefined {
  const words = query.toLowerCase().split(/\s+/).filter(Boolean)
  let sum = 0
  for (const word of words) {
    const best = Math.max(...texts.map((text, index) => fitOfWord(word, text) - index * 3))
    if (best <= -1000) return undefined
    sum += best
  }
  return sum
}

function fitOfWord(word: string, text: string): number {
  const lower = text.toLowerCase()
  const at = lower.indexOf(word)
  if (at === 0) return lower.length === word.length ? 20 : 14
  // `wait` is the whole last name of `flow.Wait`, and the beginning of others.
  if (at > 0 && isStart(text, at)) return at + word.length === lower.length ? 13 : 11
  if (at > 0) return 6
  return initialsOf(text).startsWith(word) ? 8 : -10_000
}

function isStart(text: string, at: number): boolean {
  return /[^A-Za-z0-9]/.test(text[at - 1] ?? '') || (/[A-Z]/.test(text[at] ?? '') && /[a-z]/.test(text[at - 1] ?? ''))
}

/** `mj` finds `motion.MoveJoints`. */
function initialsOf(text: string): string {
  const last = text.split(/[./]/).pop() ?? text
  return last
    .split(/[^A-Za-z0-9]+|(?<=[a-z0-9])(?=[A-Z])/)
    .map((part) => part.charAt(0))
    .join('')
    .toLowerCase()
}

/** The items that fit, the best first; all in their order without a query. */
export function found<T>(items: readonly T[], query: string, textsOf: (item: T) => readonly string[]): readonly T[] {
  if (!query.trim()) return items
  return items
    .map((item, index) => ({ item, index, score: fit(query, ...textsOf(item)) }))
    .filter((each) => each.score !== undefined)
    .toSorted((a, b) => (b.score ?? 0) - (a.score ?? 0) || a.index - b.index)
    .map((each) => each.item)
}

/** Keeping the objects of what looks as before, so that an edit draws anew only what it changes. Pure. */

/** Of a node these say where it stands in the text, and what is inside it, which is drawn by itself. */
const UNSEEN: ReadonlySet<string> = new Set(['line', 'column', 'end_line', 'children'])

/** The elements of `now`, each as the object it was before where it looks the same. */
export function shareUnchanged<T extends { readonly id: string }>(before: readonly T[], now: readonly T[]): readonly T[] {
  const known = new Map(before.map((each) => [each.id, each]))
  const kept = now.map((each) => {
    const was = known.get(each.id)
    return was && isDrawnEqual(was, each) ? was : each
  })
  return kept.length === before.length && kept.every((each, index) => each === before[index]) ? before : kept
}

/** Do two values say the same of what is seen? */
export function isDrawnEqual(one: unknown, other: unknown): boolean {
  if (Object.is(one, other)) return true
  if (typeof one !== 'object' || typeof other !== 'object' || one === null || other === null) return false
  if (one instanceof Set && other instanceof Set) return one.size === other.size && [...one].every((each) => other.has(each))
  if (Array.isArray(one) !== Array.isArray(other)) return false
  const [a, b] = [one as Record<string, unknown>, other as Record<string, unknown>]
  const isNode = 'end_line' in a
  const keys = Object.keys(a)
  return (
    keys.length === Object.keys(b).length &&
    keys.every((key) => (isNode && UNSEEN.has(key)) || (Object.hasOwn(b, key) && isDrawnEqual(a[key], b[key])))
  )
}

/** How long a row of a drawn behavior is: told by the behavior alone, never by where it is seen. Pure. */

/** About four states beside one another, which can still be read on a laptop. */
const SHORTEST_PX = 1200
/** With so many nodes rows are that short. */
const FEW = 24

/**
 * The longest row of a behavior that is drawn with so many nodes. It grows in steps, at each doubling of the nodes, so
 * that a large behavior stays about as wide as it is high, and one more node almost never breaks the rows anew.
 */
export function rowLimitFor(nodes: number): number {
  const doublings = Math.max(0, Math.ceil(Math.log2(nodes / FEW)))
  return Math.round(SHORTEST_PX * Math.SQRT2 ** doublings)
}

/** The least of these widths that is enough, else the widest; they are given in order. */
export function widthFrom(widths: readonly number[], needed: number): number {
  return widths.find((each) => each >= needed) ?? Math.max(...widths)
}

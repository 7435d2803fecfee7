/** Putting much on the canvas little by little, so that no step takes long. Pure. */

interface Placed {
  readonly id: string
  /** The one that it stands in; it comes before it. */
  readonly parentId?: string
}

/**
 * What is on the canvas after each step: first what is there already, then `most` more of the others each time,
 * until it is all; in one step where there is not much more. Nothing comes before what it stands in.
 */
export function nodeBatches<T extends Placed>(
  all: readonly T[],
  isThere: (id: string) => boolean,
  most: number,
): readonly (readonly T[])[] {
  const kept = new Set<string>()
  for (const { id, parentId } of all) {
    if (isThere(id) && (parentId === undefined || kept.has(parentId))) kept.add(id)
  }
  if (all.length - kept.size <= most) return [all]
  const steps: T[][] = []
  for (let room = 0; room < all.length - kept.size; room += most) {
    let left = room
    steps.push(all.filter(({ id }) => kept.has(id) || left-- > 0))
  }
  return [...steps, all]
}

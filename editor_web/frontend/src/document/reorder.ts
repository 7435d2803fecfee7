/** Lists in another order. Pure. */

/** With the item at `index` as many places further on; as it is where there is no such place. */
export function reordered<T>(items: readonly T[], index: number, by: number): readonly T[] {
  const target = index + by
  const item = items[index]
  if (item === undefined || target < 0 || target >= items.length) return items
  const rest = items.filter((_, each) => each !== index)
  return [...rest.slice(0, target), item, ...rest.slice(target)]
}

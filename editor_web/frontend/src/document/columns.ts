/** What makes the layout engine keep the order of a flow: in which column a node stands, and what stands above it. */
import type { ElkShape } from './elkGraph'
import type { Flow } from './flow'

/** From one node of the flow to the next, where the engine reads which arrows lead back; wider than any node. */
const APART = 100_000

/**
 * The nodes of a machine by name, its outcomes among them, as the engine takes them: what leads to a node stands before
 * it, what comes first stands above. Nodes that the flow does not know come last.
 */
export function inColumns(flow: Flow, shapes: ReadonlyMap<string, ElkShape>): ElkShape[] {
  const ranks = new Map(flow.order.map((name, rank) => [name, rank]))
  const names = new Set([...flow.downwards, ...shapes.keys()])
  return [...names].flatMap((name, rank) => {
    const shape = shapes.get(name)
    const along = (ranks.get(name) ?? ranks.size) * APART
    const down = { 'elk.position': `(${rank},${rank})` }
    return shape ? [{ ...shape, x: along, y: along, layoutOptions: { ...shape.layoutOptions, ...down } }] : []
  })
}

/**
 * A node stands in the first column behind all that lead to it, so a further node or arrow moves only what comes behind
 * it; and nothing passes what stands above it.
 */
export const COLUMNS: Readonly<Record<string, string>> = {
  'elk.layered.cycleBreaking.strategy': 'INTERACTIVE',
  'elk.layered.layering.strategy': 'LONGEST_PATH_SOURCE',
  'elk.layered.considerModelOrder.strategy': 'PREFER_NODES',
  'elk.layered.crossingMinimization.semiInteractive': 'true',
}

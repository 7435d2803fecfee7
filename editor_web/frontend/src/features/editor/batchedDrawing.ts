/** Gives the canvas its nodes: many new ones over several frames, so that the page answers meanwhile. */
import { nodeBatches } from '../../document/editing/nodeBatches'
import type { CanvasNode } from './elements'

/** So many nodes are drawn anew in well under the time of a few frames. */
const MOST = 45

export interface BatchSink {
  /** Is a node on the canvas already? */
  readonly isThere: (id: string) => boolean
  readonly give: (nodes: CanvasNode[]) => void
  /** All of them were given. */
  readonly done: () => void
}

/** Give them; returns what stops that. */
export function drawInBatches(all: readonly CanvasNode[], { isThere, give, done }: BatchSink): () => void {
  const steps = nodeBatches(all, isThere, MOST)
  let frame = 0
  const next = (index: number): void => {
    give([...(steps[index] ?? all)])
    if (index + 1 < steps.length) frame = requestAnimationFrame(() => next(index + 1))
    else done()
  }
  next(0)
  return () => cancelAnimationFrame(frame)
}

/** Lays a behavior out as it is drawn; the size of the pane has no part in it. */
import { useEffect, useState } from 'react'
import type { GraphNode } from '../../api/types'
import type { Direction } from '../../document/branching'
import { layOut, type Layout } from '../../document/layout'
import { rowLimitFor } from '../../document/rows'
import { flatten } from '../../document/tree'
import { layOutByElk } from '../../components/elk'

export interface LaidOut {
  /** The behavior as it is drawn, perhaps with folded containers. */
  readonly root: GraphNode
  /** The whole behavior. */
  readonly whole: GraphNode
  readonly layout: Layout
  readonly direction: Direction
}

/** Lays `root` out, which is `whole` with containers folded; until that is done the layout of before stays. */
export function useLayout(root: GraphNode, whole: GraphNode, direction: Direction) {
  const [laidOut, setLaidOut] = useState<LaidOut>()
  const [problem, setProblem] = useState<string>()

  useEffect(() => {
    let current = true
    async function run(): Promise<void> {
      const begun = performance.now()
      // Of the whole: rows do not break anew because a container is folded.
      const rowLimit = rowLimitFor(flatten(whole).length)
      const layout = await layOut(root, { direction, rowLimit }, layOutByElk)
      performance.measure('flexcell:layout', { start: begun })
      if (current) setLaidOut({ root, whole, direction, layout })
    }
    run().catch((error: unknown) => current && setProblem(error instanceof Error ? error.message : String(error)))
    return () => {
      current = false
    }
  }, [root, whole, direction])

  return { laidOut: laidOut?.whole === whole ? laidOut : undefined, problem }
}

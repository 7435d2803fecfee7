/** Lays a behavior out in the direction that fills the pane best. */
import { useEffect, useState } from 'react'
import type { GraphNode } from '../../api/types'
import { zoom, type Size } from '../../document/geometry'
import { layOut, type Direction, type Layout, type LayoutCall, type Style } from '../../document/layout'
import { layOutRoughly } from '../../document/roughLayout'
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

export type Flow = Direction | 'AUTO'

/** Lays `root` out, which is `whole` with containers folded; until that is done the layout of before stays. */
export function useLayout(root: GraphNode, whole: GraphNode, flow: Flow, pane: Size | undefined) {
  const [laidOut, setLaidOut] = useState<LaidOut>()
  const [problem, setProblem] = useState<string>()
  const measured = pane !== undefined
  // Only a real change of size is worth another layout; dragging a border a little is not.
  const step = (length: number) => Math.round(2 * Math.log2(Math.max(1, length)))
  const size = pane ? `${step(pane.width)} ${step(pane.height)}` : ''

  useEffect(() => {
    let current = true
    async function run(): Promise<void> {
      const area = pane ?? { width: 1, height: 1 }
      const begun = performance.now()
      const isLarge = flatten(root).length > MANY
      const inStyle = async (style: Style, call: LayoutCall) => ({ root, style, layout: await layOut(root, style, call) })
      // What is large is laid out once, in the style that is best by a rough look.
      const all = await Promise.all(stylesOf(flow, area).map((style) => inStyle(style, isLarge ? layOutRoughly : layOutByElk)))
      const best = all.reduce((a, b) => (zoom(b.layout.size, area) > zoom(a.layout.size, area) * 1.05 ? b : a))
      const chosen = isLarge ? await inStyle(best.style, layOutByElk) : best
      performance.measure('flexcell:layout', { start: begun })
      if (current) setLaidOut({ root, whole, direction: chosen.style.direction, layout: chosen.layout })
    }
    if (measured) {
      run().catch((error: unknown) => current && setProblem(error instanceof Error ? error.message : String(error)))
    }
    return () => {
      current = false
    }
    // oxlint-disable-next-line react/exhaustive-deps -- the pane counts by its rough size only
  }, [root, whole, flow, measured, size])

  return { laidOut: laidOut?.whole === whole ? laidOut : undefined, problem }
}

/** With more nodes than this the engine is asked once. */
const MANY = 120

/** Row lengths that are tried, in widths of the pane; a longer row wins where shorter ones gain little. */
const ROWS = [Infinity, 1, 1.3, 1.6, 2, 2.5, 3.2]

/** What is tried: chains in rows of several lengths, and downwards where the reader has not chosen. */
function stylesOf(flow: Flow, pane: Size): readonly Style[] {
  if (flow === 'RIGHT') return ROWS.map((widths) => ({ direction: 'RIGHT', rowLimit: widths * pane.width }))
  if (flow === 'DOWN') return [{ direction: 'DOWN', rowLimit: Infinity }]
  return [...stylesOf('RIGHT', pane), ...stylesOf('DOWN', pane)]
}

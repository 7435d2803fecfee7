/** A run at a glance: one cell for each of its steps, lit by the run that is shown here. */
import { useMemo } from 'react'
import { useLive } from '../../api/live'
import { useHolds, useNodePart } from '../../api/liveParts'
import type { GraphNode } from '../../api/types'
import { stripCells, progressText } from '../../document/runProgress'
import { statusOf } from '../../document/runState'
import { pathWords } from '../../document/path'

export function RunStrip({ root }: { root: GraphNode }) {
  const cells = useMemo(() => stripCells(root), [root])
  const words = useLive((s) =>
    progressText(
      cells,
      s.nodes,
      s.control?.waiting.map((each) => each.path),
    ),
  )
  return (
    <div className="run-strip">
      <div className="run-cells" role="img" aria-label={words}>
        {cells.map((node) => (
          <Cell key={node.path} path={node.path} />
        ))}
      </div>
      <span className="quiet" aria-hidden>
        {words}
      </span>
    </div>
  )
}

function Cell({ path }: { path: string }) {
  const status = useNodePart(path, (live) => statusOf(live?.status ?? 'idle'))
  const waits = useHolds((control) => control?.waiting.some((each) => each.path === path) ?? false)
  return <span className={`run-cell is-${waits ? 'stopped' : status}`} title={`${pathWords(path)}: ${waits ? 'waits' : status}`} />
}

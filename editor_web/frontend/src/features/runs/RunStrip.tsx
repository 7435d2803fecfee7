/** A run at a glance: one cell for each of its steps, lit by the run that is shown here. */
import { Stack, Text } from '@mantine/core'
import { useMemo } from 'react'
import { useLive } from '../../api/live'
import { useHolds, useNodePart } from '../../api/liveParts'
import type { GraphNode } from '../../api/types'
import { stripCells, pathWords, progressText } from '../../document/runProgress'
import { statusOf } from '../../document/runState'
import classes from './runs.module.css'

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
    <Stack gap="4xs">
      <div className={classes.cells} role="img" aria-label={words}>
        {cells.map((node) => (
          <Cell key={node.path} path={node.path} />
        ))}
      </div>
      <Text span fz="0.78rem" c="dimmed" aria-hidden>
        {words}
      </Text>
    </Stack>
  )
}

function Cell({ path }: { path: string }) {
  const status = useNodePart(path, (live) => statusOf(live?.status ?? 'idle'))
  const waits = useHolds((control) => control?.waiting.some((each) => each.path === path) ?? false)
  return (
    <span className={classes.cell} data-status={waits ? 'stopped' : status} title={`${pathWords(path)}: ${waits ? 'waits' : status}`} />
  )
}

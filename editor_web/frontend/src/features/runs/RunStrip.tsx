/** A run at a glance: one cell for each of its steps, lit by the run that is shown here. */
import { Box, Group, Stack, Text } from '@mantine/core'
import { useMemo } from 'react'
import { useLive } from '../../api/live'
import { useHolds, useNodePart } from '../../api/liveParts'
import type { GraphNode } from '../../api/types'
import { stripCells, progressText } from '../../document/runProgress'
import { statusOf } from '../../document/runState'
import { pathWords } from '../../document/path'

const LIT: Readonly<Partial<Record<string, string>>> = {
  active: 'var(--active)',
  done: 'var(--done)',
  failed: 'var(--failed)',
  stopped: 'var(--stopped)',
}

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
      <Group gap={2} h={10} wrap="nowrap" align="stretch" role="img" aria-label={words}>
        {cells.map((node) => (
          <Cell key={node.path} path={node.path} />
        ))}
      </Group>
      <Text span fz="0.78rem" c="dimmed" aria-hidden>
        {words}
      </Text>
    </Stack>
  )
}

function Cell({ path }: { path: string }) {
  const status = useNodePart(path, (live) => statusOf(live?.status ?? 'idle'))
  const waits = useHolds((control) => control?.waiting.some((each) => each.path === path) ?? false)
  const shown = waits ? 'stopped' : status
  return (
    <Box
      flex={1}
      miw={2}
      bdrs={3}
      bg={LIT[shown] ?? 'var(--line)'}
      {...(shown === 'active' ? { style: { boxShadow: '0 0 0 2px var(--active-glow)' } } : {})}
      title={`${pathWords(path)}: ${waits ? 'waits' : status}`}
    />
  )
}

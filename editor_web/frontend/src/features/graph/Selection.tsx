/** What is known of the selected node: kind, state, outcomes, last visit, why it failed. */
import { Box, Group, Text } from '@mantine/core'
import { lookup } from '../../document/dict'
import { useLive } from '../../api/live'
import type { GraphNode } from '../../api/types'
import { Elapsed } from '../../components/Elapsed'
import { KindIcon } from '../../components/KindIcon'
import { StatusBadge } from '../../components/StatusBadge'
import { nodeWords, statusOf } from '../../document/runState'
import { duration } from '../../document/time'
import { kindLabel } from '../../document/tree'

export function Selection({ node }: { node: GraphNode }) {
  const live = useLive((s) => lookup(s.nodes, node.path))
  return (
    <Box
      component="section"
      flex="none"
      px={14}
      py="xs"
      bg="var(--surface)"
      style={{ borderTop: '1px solid var(--line)' }}
      aria-label={`Selected: ${node.name}`}
    >
      <Group gap="xs">
        <KindIcon icon={node.icon} />
        <strong>{node.name}</strong>
        {live && <StatusBadge look={statusOf(live.status)} words={nodeWords(live.status, live.status === 'active' ? '' : live.outcome)} />}
      </Group>
      <dl className="facts" style={{ marginTop: 6 }}>
        <dt>Kind</dt>
        <dd>{kindLabel(node.kind)}</dd>
        {node.title && (
          <>
            <dt>Runs</dt>
            <dd>
              <Text span inherit ff="monospace">
                {node.title}
              </Text>
            </dd>
          </>
        )}
        <dt>Outcomes</dt>
        <dd>{node.outcomes.join(', ') || '–'}</dd>
        {node.conditions.length > 0 && (
          <>
            <dt>Ends</dt>
            <dd>
              {node.conditions.map((condition) => (
                <div key={condition}>{condition}</div>
              ))}
            </dd>
          </>
        )}
        <dt>Visits</dt>
        <dd>{live?.visits ?? 0}</dd>
        <dt>Time</dt>
        <dd>{live?.status === 'active' ? <Elapsed sinceS={live.entered_s} /> : live ? duration(live.duration_s) : '–'}</dd>
        {live?.cause && (
          <>
            <dt>Cause</dt>
            <Text component="dd" inherit c="var(--failed)">
              {live.cause}
            </Text>
          </>
        )}
      </dl>
    </Box>
  )
}

/** One aligned visit: when it was in each run, why it ended so, and the values that it read and wrote. */
import { Box, Text, Title } from '@mantine/core'
import type { AlignedVisit, DataDifference, Visit } from '../../api/types'
import { PageLink } from '../../components/PageLink'
import { endWords, type Side } from '../../document/comparison'
import { duration } from '../../document/time'
import { DifferenceTable } from './DifferenceTable'

interface VisitDetailsProps {
  readonly visit: AlignedVisit
  readonly data: readonly DataDifference[]
  /** The page of a run at a time of it, with the node selected. */
  readonly href: (side: Side, timeS: number, path: string) => string
  readonly onOpen: (href: string) => void
}

export function VisitDetails({ visit, data, href, onOpen }: VisitDetailsProps) {
  return (
    <Box px="md" pb="sm">
      <Title order={3} fz="0.84rem" mt="sm" mb="xs">
        {visit.path}
      </Title>
      <OfRun side="left" visit={visit.left} href={href} onOpen={onOpen} />
      <OfRun side="right" visit={visit.right} href={href} onOpen={onOpen} />
      <Title order={3} fz="0.84rem" mt="sm" mb="xs">
        Values that differ
      </Title>
      {data.length === 0 ? (
        <Text fz="sm" c="dimmed">
          It read and wrote the same values.
        </Text>
      ) : (
        <DifferenceTable rows={data.map((each) => ({ ...each, at: `${each.kind} ${each.at}` }))} name="Value" />
      )}
    </Box>
  )
}

interface OfRunProps extends Pick<VisitDetailsProps, 'href' | 'onOpen'> {
  readonly side: Side
  readonly visit: Visit | null
}

function OfRun({ side, visit, href, onOpen }: OfRunProps) {
  const name = side === 'left' ? 'Left' : 'Right'
  if (!visit) {
    return (
      <Text inherit>
        <Text span inherit fw={620} c="dimmed">
          {name}
        </Text>{' '}
        not entered
      </Text>
    )
  }
  const target = href(side, visit.end_s ?? visit.start_s, visit.path)
  return (
    <Box my="xs">
      <Text span inherit fw={620} c="dimmed">
        {name}
      </Text>{' '}
      {endWords(visit)}, from {duration(visit.start_s)} {visit.end_s !== null && `to ${duration(visit.end_s)} `}
      <PageLink href={target} onOpen={() => onOpen(target)}>
        Open the {side} run there
      </PageLink>
      {visit.cause && (
        <Text inherit c="var(--failed)" style={{ overflowWrap: 'anywhere' }}>
          {visit.cause}
        </Text>
      )}
    </Box>
  )
}

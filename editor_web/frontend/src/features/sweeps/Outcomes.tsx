/** How runs ended with the interval of each share, and why they failed: a cause shows its runs. */
import { Box, Group, List, Table, Text, UnstyledButton, VisuallyHidden } from '@mantine/core'
import type { CauseGroup, OutcomeShare } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { intervalText, percent } from '../../document/sweeps'
import { IntervalBar } from './IntervalBar'
import { ResultTable } from './ResultTable'
import classes from './sweeps.module.css'

export function OutcomeTable({ outcomes, done }: { readonly outcomes: readonly OutcomeShare[]; readonly done: number }) {
  return (
    <ResultTable label="Table of outcomes">
      <Table.Thead>
        <Table.Tr>
          <Table.Th scope="col">Outcome</Table.Th>
          <Table.Th scope="col" ta="right">
            Runs
          </Table.Th>
          <Table.Th scope="col" ta="right">
            Share
          </Table.Th>
          <Table.Th scope="col">Interval</Table.Th>
          <Table.Td />
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {outcomes.map((each) => (
          <Table.Tr key={each.label}>
            <Table.Th scope="row">
              <Group gap="3xs" wrap="nowrap">
                <StatusIcon status={each.success ? 'done' : 'failed'} size={14} />
                <VisuallyHidden>{each.success ? 'success: ' : 'no success: '}</VisuallyHidden>
                {each.label}
              </Group>
            </Table.Th>
            <Table.Td ta="right">{each.runs}</Table.Td>
            <Table.Td ta="right">{percent(each.runs / done)}</Table.Td>
            <Table.Td>{intervalText(each.interval)}</Table.Td>
            <Table.Td w="34%" miw={90}>
              <IntervalBar interval={each.interval} rate={each.runs / done} isBad={!each.success} />
            </Table.Td>
          </Table.Tr>
        ))}
      </Table.Tbody>
    </ResultTable>
  )
}

export interface CauseListProps {
  readonly causes: readonly CauseGroup[]
  /** An example of the cause whose runs are listed. */
  readonly chosen: number | undefined
  readonly onChoose: (example: number | undefined) => void
}

export function CauseList({ causes, chosen, onChoose }: CauseListProps) {
  return (
    <List listStyleType="none" aria-label="Causes of failures">
      {causes.map((each) => (
        <Box component="li" key={`${each.at} ${each.message}`} mb="4xs">
          <CauseButton cause={each} chosen={chosen} onChoose={onChoose} />
        </Box>
      ))}
    </List>
  )
}

/** A cause, pressed where its runs are listed. */
export function CauseButton({ cause, chosen, onChoose }: { readonly cause: CauseGroup } & Pick<CauseListProps, 'chosen' | 'onChoose'>) {
  const example = cause.examples[0]
  const isChosen = chosen !== undefined && chosen === example
  return (
    <UnstyledButton
      className={`${classes.cause} pick-row`}
      aria-pressed={isChosen}
      onClick={() => onChoose(isChosen ? undefined : example)}
    >
      <Text span inherit fw={640} c="var(--failed)">
        {cause.runs} {cause.runs === 1 ? 'run' : 'runs'}
      </Text>
      <span>
        {cause.message}
        {cause.at && (
          <Text span inherit display="block" ff="monospace" c="var(--quiet)">
            {cause.at}
          </Text>
        )}
      </span>
    </UnstyledButton>
  )
}

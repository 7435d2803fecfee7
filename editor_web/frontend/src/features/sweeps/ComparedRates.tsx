/** Both success rates, their difference with its interval, the verdict, and the runs that are broken. */
import { Anchor, Box, Table } from '@mantine/core'
import type { SweepComparison } from '../../api/types'
import { StatusBadge } from '../../components/StatusBadge'
import { differenceScale, pointsIntervalText, pointsText, ratesOf, shareText } from '../../document/baselines'
import { verdictWords } from '../../document/sweeps'
import { IntervalBar } from './IntervalBar'
import { Note } from './Note'
import { ResultTable, UnseenHead } from './ResultTable'
import classes from './bars.module.css'

export function ComparedRates({
  compared: { comparison, verdict, words },
  onSelect,
}: {
  readonly compared: SweepComparison
  readonly onSelect: (run: number) => void
}) {
  const { pair, interval, margin, broken, changed } = comparison
  const rates = ratesOf(pair)
  const runs = rates[0]?.runs ?? 0
  const difference = (pair.only_second - pair.only_first) / runs
  const place = differenceScale(interval, margin)
  const badge = verdictWords(verdict)
  return (
    <>
      <ResultTable label="Table of both versions">
        <UnseenHead>
          <Table.Tr>
            <Table.Th scope="col">Version</Table.Th>
            <Table.Th scope="col">Succeeded</Table.Th>
            <Table.Th scope="col">Rate</Table.Th>
            <Table.Td />
          </Table.Tr>
        </UnseenHead>
        <Table.Tbody>
          {rates.map((each) => (
            <Table.Tr key={each.name}>
              <Table.Th scope="row">{each.name}</Table.Th>
              <Table.Td ta="right">
                {each.successes} of {each.runs}
              </Table.Td>
              <Table.Td ta="right">{shareText(each.successes, each.runs)}</Table.Td>
              <Table.Td w="34%" miw={90} />
            </Table.Tr>
          ))}
          <Table.Tr>
            <Table.Th scope="row">Difference</Table.Th>
            <Table.Td ta="right">{pointsIntervalText(interval)}</Table.Td>
            <Table.Td ta="right">{pointsText(difference)}</Table.Td>
            <Table.Td w="34%" miw={90}>
              <Box component="span" display="block" mx={5} pos="relative" aria-hidden>
                <span className={classes.zero} style={{ left: `${100 * place(0)}%` }} />
                {margin !== null && <span className={classes.zero} data-margin style={{ left: `${100 * place(-margin)}%` }} />}
                <IntervalBar interval={[place(interval[0]), place(interval[1])]} rate={place(difference)} isBad={interval[1] < 0} />
              </Box>
            </Table.Td>
          </Table.Tr>
        </Table.Tbody>
      </ResultTable>
      <Note>
        {badge && <StatusBadge look={badge[0]} words={badge[1]} />} This version is {words}.
      </Note>
      {broken.length > 0 && (
        <Note>
          Broken:{' '}
          {broken.map((run) => (
            <Anchor
              c="var(--accent)"
              key={run}
              component="button"
              type="button"
              inherit
              mr="2xs"
              aria-label={`Run ${run}`}
              onClick={() => onSelect(run)}
            >
              #{run}
            </Anchor>
          ))}
          {pair.only_first > broken.length && `and ${pair.only_first - broken.length} more`}
        </Note>
      )}
      {changed.length > 0 && <Note isQuiet>Different: {changed.join(', ')}.</Note>}
    </>
  )
}

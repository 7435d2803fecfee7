/** The last runs of a behavior: how many succeeded, how long they and their nodes took, and two of them to compare. */
import { Box, Button, Flex, NativeSelect } from '@mantine/core'
import { IconGitCompare } from '@tabler/icons-react'
import { useState } from 'react'
import { comparisonQueries } from '../api/comparison'
import { useAnswer } from '../api/queryClient'
import { Empty } from '../components/Empty'
import { PageHead } from '../components/PageHead'
import { Panel } from '../components/Panel'
import { DurationTable } from '../features/trend/DurationTable'
import { RunBars } from '../features/trend/RunBars'
import { countText } from '../features/trend/words'
import classes from './pages.module.css'
import { compareHref, runHref } from './route'

const LAST = [10, 20, 50, 100, 200]

export function TrendPage({ behavior, onOpen }: { readonly behavior: string; readonly onOpen: (href: string) => void }) {
  const [last, setLast] = useState(20)
  const [chosen, setChosen] = useState<readonly string[]>([])
  const { value: trend, problem } = useAnswer(comparisonQueries.trend(behavior, last))
  if (problem) return <Empty title="The runs cannot be read">{problem}</Empty>
  if (!trend) return <div role="status" aria-label="Loading" />
  // Newest first, so the older one is the left one.
  const [left, right] = trend.runs
    .map((run) => run.id)
    .filter((id) => chosen.includes(id))
    .toReversed()
  return (
    <Flex direction="column" flex={1} mih={0}>
      <PageHead title={`Last runs of ${behavior}`} words={countText(trend)} isStatus>
        <NativeSelect
          size="xs"
          aria-label="Number of runs"
          value={String(last)}
          data={LAST.map((each) => ({ value: String(each), label: `Last ${each}` }))}
          onChange={(event) => setLast(Number(event.currentTarget.value))}
        />
        <Button
          size="xs"
          variant="default"
          leftSection={<IconGitCompare size={15} aria-hidden />}
          disabled={left === undefined || right === undefined}
          onClick={() => left !== undefined && right !== undefined && onOpen(compareHref(left, right))}
        >
          Compare
        </Button>
      </PageHead>
      {trend.runs.length === 0 ? (
        <Empty title="No runs">The journal has no run of this behavior.</Empty>
      ) : (
        <Box className={classes.pair ?? ''} __vars={{ '--widths': 'minmax(0, 2fr) minmax(0, 3fr)' }}>
          <Panel title="Runs">
            <RunBars
              runs={trend.runs}
              href={runHref}
              onOpen={(run) => onOpen(runHref(run))}
              chosen={chosen}
              onChoose={(run, isChosen) => setChosen([...chosen.filter((each) => each !== run), ...(isChosen ? [run] : [])].slice(-2))}
            />
          </Panel>
          <Panel title="Durations of runs that succeeded">
            {trend.duration ? <DurationTable whole={trend.duration} nodes={trend.nodes} /> : <Empty title="None of these runs succeeded" />}
          </Panel>
        </Box>
      )}
    </Flex>
  )
}

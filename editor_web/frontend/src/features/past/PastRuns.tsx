/** The runs of the journal: found by words, by how they ended, by the day; failures are one press away. */
import { ActionIcon, Box, Button, Checkbox, CloseButton, Group, List, Menu, Text, TextInput } from '@mantine/core'
import { useDebouncedValue } from '@mantine/hooks'
import { IconDots, IconGitCompare, IconHistory, IconSearch } from '@tabler/icons-react'
import { useId, useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { useLastAnswer } from '../../api/queryClient'
import { pastQueries, type PastQuery } from '../../api/timeline'
import type { PastRunBody } from '../../api/types'
import { Empty } from '../../components/Empty'
import { PageLink } from '../../components/PageLink'
import { RunTime } from '../../components/RunTime'
import { RunBadge } from '../../components/StatusBadge'
import { startTime, wallTime } from '../../document/time'
import { dayEndS, dayStartS } from './days'
import classes from './past.module.css'

const KINDS = [
  ['all', 'All'],
  ['failed', 'Failed'],
  ['finished', 'Succeeded'],
  ['stopped', 'Stopped'],
  ['running', 'Not ended'],
] as const
const PAGE = 50

export interface PastRunsProps {
  readonly href: (run: string) => string
  /** The page of the last runs of a behavior. */
  readonly trendHref: (behavior: string) => string
  readonly onOpen: (href: string) => void
  /** Compare two runs; without a left one, with the last good run. */
  readonly onCompare: (left: string | undefined, right: string) => void
}

export function PastRuns({ href, trendHref, onOpen, onCompare }: PastRunsProps) {
  const [text, setText] = useState('')
  const [kind, setKind] = useState<string>('all')
  const [since, setSince] = useState('')
  const [until, setUntil] = useState('')
  const [limit, setLimit] = useState(PAGE)
  const [chosen, setChosen] = useState<readonly PastRunBody[]>([])
  const { value: found, problem } = useFound({ text, kind, sinceS: dayStartS(since), untilS: dayEndS(until), limit })
  const isFiltered = text !== '' || kind !== 'all' || since !== '' || until !== ''

  /** The two that were chosen last. */
  function choose(run: PastRunBody, isChosen: boolean): void {
    const others = chosen.filter((each) => each.id !== run.id)
    setChosen(isChosen ? [...others, run].slice(-2) : others)
  }

  return (
    <Box h="100%" px="md" pt="sm" pb="lg" style={{ overflow: 'auto' }}>
      <Group gap="xs">
        <TextInput
          size="sm"
          flex="1 1 220px"
          aria-label="Find a run"
          placeholder="Behavior, outcome, cause or run"
          leftSection={<IconSearch size={15} aria-hidden />}
          rightSection={text && <CloseButton size="sm" aria-label="Clear" onClick={() => setText('')} />}
          value={text}
          onChange={(event) => setText(event.currentTarget.value)}
        />
        <Day label="from" value={since} {...(until && { max: until })} onChange={setSince} />
        <Day label="to" value={until} {...(since && { min: since })} onChange={setUntil} />
      </Group>
      <Group gap="3xs" mt="sm" mb="2xs" role="group" aria-label="How they ended">
        {KINDS.map(([id, words]) => (
          <Button
            key={id}
            size="compact-sm"
            radius="xl"
            variant={kind === id ? 'light' : 'default'}
            aria-pressed={kind === id}
            onClick={() => setKind(id)}
          >
            {words}{' '}
            <Text span inherit fw={620} ml="4xs" c={id === 'failed' ? 'var(--failed)' : 'var(--quiet)'}>
              {found?.counts[id] ?? 0}
            </Text>
          </Button>
        ))}
      </Group>
      <CompareChosen chosen={chosen} onCompare={onCompare} onNone={() => setChosen([])} />
      <Refusal>{problem}</Refusal>
      {found?.runs.length === 0 && (
        <Empty icon={<IconHistory size={26} stroke={1.4} aria-hidden />} title={isFiltered ? 'No run matches' : 'No past runs'}>
          {isFiltered
            ? 'Use fewer words, another day, or show all.'
            : 'Every run that is started here is kept in the journal and listed on this page.'}
        </Empty>
      )}
      <List listStyleType="none" aria-label="Past runs">
        {found?.runs.map((run) => (
          <Box component="li" key={run.id} style={{ borderBottom: '1px solid var(--line)' }}>
            <Group gap="xs" align="start" wrap="nowrap">
              <Checkbox
                mt="xs"
                size="xs"
                aria-label={`Compare ${run.behavior} of ${startTime(run, found.runs)}`}
                checked={chosen.some((each) => each.id === run.id)}
                onChange={(event) => choose(run, event.currentTarget.checked)}
              />
              <Item run={run} href={href(run.id)} onOpen={() => onOpen(href(run.id))} />
              <Menu position="bottom-end" withinPortal>
                <Menu.Target>
                  <ActionIcon
                    mt="xs"
                    variant="subtle"
                    color="gray"
                    size="sm"
                    aria-label={`More of ${run.behavior} of ${startTime(run, found.runs)}`}
                  >
                    <IconDots size={15} />
                  </ActionIcon>
                </Menu.Target>
                <Menu.Dropdown>
                  <Menu.Item onClick={() => onCompare(undefined, run.id)}>Compare with the last good run</Menu.Item>
                  <Menu.Item onClick={() => onOpen(trendHref(run.behavior))}>Last runs of {run.behavior}</Menu.Item>
                </Menu.Dropdown>
              </Menu>
            </Group>
          </Box>
        ))}
      </List>
      {found && found.total > found.runs.length && (
        <Button
          size="compact-sm"
          variant="default"
          mt="sm"
          mx="auto"
          display="block"
          onClick={() => setLimit(Math.min(200, limit + PAGE))}
          disabled={limit >= 200}
        >
          {limit >= 200 ? `${found.total - found.runs.length} older ones: narrow the search` : `Show more of ${found.total}`}
        </Button>
      )}
    </Box>
  )
}

function Item({ run, href, onOpen }: { run: PastRunBody; href: string; onOpen: () => void }) {
  return (
    <PageLink className={`${classes.item} pick-row`} href={href} onOpen={onOpen}>
      <Group gap="sm" wrap="nowrap" justify="space-between">
        <Text span inherit truncate fw={620}>
          {run.behavior}
        </Text>
        <RunBadge run={run.status === 'running' && !run.here ? { status: 'interrupted' } : run} />
      </Group>
      <Text span display="block" fz="0.78rem" c="dimmed">
        {wallTime(run.started_at_s)} · <RunTime run={run} /> · {run.events} events{run.recording && ' · recorded'}
      </Text>
      <Text span display="block" fz="0.72rem" ff="monospace" c="dimmed">
        {run.id}
      </Text>
      {run.cause && (
        <Text span fz="0.78rem" lineClamp={2} c={run.failed ? 'var(--failed)' : 'dimmed'}>
          {run.cause}
        </Text>
      )}
    </PageLink>
  )
}

interface DayProps {
  readonly label: string
  readonly value: string
  readonly min?: string
  readonly max?: string
  readonly onChange: (day: string) => void
}

function Day({ label, onChange, ...of }: DayProps) {
  const id = useId()
  return (
    <Group gap="3xs" wrap="nowrap">
      <Text component="label" htmlFor={id} fz="0.8rem" c="dimmed">
        {label}
      </Text>
      <TextInput id={id} type="date" size="xs" {...of} onChange={(event) => onChange(event.currentTarget.value)} />
    </Group>
  )
}

interface CompareChosenProps extends Pick<PastRunsProps, 'onCompare'> {
  readonly chosen: readonly PastRunBody[]
  readonly onNone: () => void
}

/** What can be done with the runs that are ticked; the older one is the left one. */
function CompareChosen({ chosen, onCompare, onNone }: CompareChosenProps) {
  const [left, right] = chosen.toSorted((one, other) => one.started_at_s - other.started_at_s)
  return (
    <Group gap="sm" my="xs" wrap="nowrap" h={30} role="group" aria-label="Selected runs">
      <Button
        size="xs"
        leftSection={<IconGitCompare size={15} aria-hidden />}
        disabled={!right}
        onClick={() => left && right && onCompare(left.id, right.id)}
      >
        Compare
      </Button>
      <Text span inherit truncate c="dimmed">
        {left && right
          ? `${left.behavior} of ${wallTime(left.started_at_s)} with ${right.behavior} of ${wallTime(right.started_at_s)}`
          : left
            ? 'Select a second run.'
            : 'Select two runs to compare.'}
      </Text>
      {left && (
        <Button size="xs" variant="subtle" color="gray" flex="none" onClick={onNone}>
          Select none
        </Button>
      )}
    </Group>
  )
}

const PATIENCE_MS = 150

/** What matches; asked for when nobody has typed for a moment, and again when a run begins or ends. */
function useFound(query: PastQuery) {
  const [asked] = useDebouncedValue(JSON.stringify(query), PATIENCE_MS)
  return useLastAnswer(pastQueries.runs(JSON.parse(asked) as PastQuery))
}

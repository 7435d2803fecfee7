/** The runs of the journal: found by words, by how they ended, by the day; failures are one press away. */
import './past.css'
import { ActionIcon, Button, Checkbox, CloseButton, Group, Menu, TextInput } from '@mantine/core'
import { useDebouncedValue } from '@mantine/hooks'
import { IconDots, IconGitCompare, IconHistory, IconSearch } from '@tabler/icons-react'
import { useState } from 'react'
import { useLastAnswer } from '../../api/queryClient'
import { pastQueries, type PastQuery } from '../../api/timeline'
import type { PastRunBody } from '../../api/types'
import { Empty } from '../../components/Empty'
import { RunBadge } from '../../components/StatusBadge'
import { duration, wallTime } from '../../document/time'
import { dayEndS, dayStartS } from './days'

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
    <div className="past-runs">
      <div className="past-filters">
        <TextInput
          size="sm"
          className="past-find"
          aria-label="Find a run"
          placeholder="Behavior, outcome, cause or run"
          leftSection={<IconSearch size={15} aria-hidden />}
          rightSection={text && <CloseButton size="sm" aria-label="Clear" onClick={() => setText('')} />}
          value={text}
          onChange={(event) => setText(event.currentTarget.value)}
        />
        <label className="past-day">
          from <input type="date" value={since} max={until || undefined} onChange={(event) => setSince(event.currentTarget.value)} />
        </label>
        <label className="past-day">
          to <input type="date" value={until} min={since || undefined} onChange={(event) => setUntil(event.currentTarget.value)} />
        </label>
      </div>
      <div className="past-kinds" role="group" aria-label="How they ended">
        {KINDS.map(([id, words]) => (
          <button key={id} type="button" className={`past-kind is-${id}`} aria-pressed={kind === id} onClick={() => setKind(id)}>
            {words} <span className="past-count">{found?.counts[id] ?? 0}</span>
          </button>
        ))}
      </div>
      <CompareChosen chosen={chosen} onCompare={onCompare} onNone={() => setChosen([])} />
      {problem && (
        <p className="past-problem" role="alert">
          {problem}
        </p>
      )}
      {found?.runs.length === 0 && (
        <Empty icon={<IconHistory size={26} stroke={1.4} aria-hidden />} title={isFiltered ? 'No run matches' : 'No past runs'}>
          {isFiltered
            ? 'Use fewer words, another day, or show all.'
            : 'Every run that is started here is kept in the journal and listed on this page.'}
        </Empty>
      )}
      <ul className="plain-list" aria-label="Past runs">
        {found?.runs.map((run) => (
          <li key={run.id} className="past-row">
            <Checkbox
              size="xs"
              aria-label={`Compare ${run.behavior} of ${wallTime(run.started_at_s)}`}
              checked={chosen.some((each) => each.id === run.id)}
              onChange={(event) => choose(run, event.currentTarget.checked)}
            />
            <Item run={run} href={href(run.id)} onOpen={() => onOpen(href(run.id))} />
            <Menu position="bottom-end" withinPortal>
              <Menu.Target>
                <ActionIcon variant="subtle" color="gray" size="sm" aria-label={`More of ${run.behavior} of ${wallTime(run.started_at_s)}`}>
                  <IconDots size={15} />
                </ActionIcon>
              </Menu.Target>
              <Menu.Dropdown>
                <Menu.Item onClick={() => onCompare(undefined, run.id)}>Compare with the last good run</Menu.Item>
                <Menu.Item onClick={() => onOpen(trendHref(run.behavior))}>Last runs of {run.behavior}</Menu.Item>
              </Menu.Dropdown>
            </Menu>
          </li>
        ))}
      </ul>
      {found && found.total > found.runs.length && (
        <button type="button" className="command past-more" onClick={() => setLimit(Math.min(200, limit + PAGE))} disabled={limit >= 200}>
          {limit >= 200 ? `${found.total - found.runs.length} older ones: narrow the search` : `Show more of ${found.total}`}
        </button>
      )}
    </div>
  )
}

function Item({ run, href, onOpen }: { run: PastRunBody; href: string; onOpen: () => void }) {
  return (
    <a
      className="past-item"
      href={href}
      onClick={(event) => {
        if (event.metaKey || event.ctrlKey || event.shiftKey || event.button !== 0) return
        event.preventDefault()
        onOpen()
      }}
    >
      <span className="past-item-name">{run.behavior}</span>
      <RunBadge run={run.status === 'running' && !run.here ? { status: 'interrupted' } : run} />
      <span className="quiet past-item-facts">
        {wallTime(run.started_at_s)} · {duration(run.duration_s)} · {run.events} events{run.recording && ' · recorded'}
      </span>
      <span className="quiet mono past-item-id">{run.id}</span>
      {run.cause && <span className={`past-item-cause${run.failed ? '' : ' quiet'}`}>{run.cause}</span>}
    </a>
  )
}

interface CompareChosenProps extends Pick<PastRunsProps, 'onCompare'> {
  readonly chosen: readonly PastRunBody[]
  readonly onNone: () => void
}

/** What can be done with the runs that are ticked; the older one is the left one. */
function CompareChosen({ chosen, onCompare, onNone }: CompareChosenProps) {
  const [left, right] = chosen.toSorted((one, other) => one.started_at_s - other.started_at_s)
  if (!left) return null
  return (
    <Group gap="sm" my="xs" role="group" aria-label="Selected runs">
      <Button
        size="xs"
        leftSection={<IconGitCompare size={15} aria-hidden />}
        disabled={!right}
        onClick={() => right && onCompare(left.id, right.id)}
      >
        Compare
      </Button>
      <span className="quiet">
        {right
          ? `${left.behavior} of ${wallTime(left.started_at_s)} with ${right.behavior} of ${wallTime(right.started_at_s)}`
          : 'Select a second run.'}
      </span>
      <Button size="xs" variant="subtle" color="gray" onClick={onNone}>
        Select none
      </Button>
    </Group>
  )
}

const PATIENCE_MS = 150

/** What matches; asked for when nobody has typed for a moment, and again when a run begins or ends. */
function useFound(query: PastQuery) {
  const [asked] = useDebouncedValue(JSON.stringify(query), PATIENCE_MS)
  return useLastAnswer(pastQueries.runs(JSON.parse(asked) as PastQuery))
}

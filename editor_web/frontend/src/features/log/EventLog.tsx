/** What happened in the watched run, newest last, with the cause chains of failures to unfold. */
import { Box, Button, CloseButton, Group, SegmentedControl, Switch, Text, TextInput } from '@mantine/core'
import { useElementSize } from '@mantine/hooks'
import { IconChevronDown, IconChevronRight, IconListDetails, IconSearch } from '@tabler/icons-react'
import { memo, useEffect, useMemo, useRef, useState } from 'react'
import { useLive } from '../../api/live'
import type { LogLine } from '../../api/types'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { causeWords } from '../../document/failure'
import classes from './EventLog.module.css'
import { passing, type Level } from './filter'

/** Lines in the DOM; the others are counted. */
const SHOWN = 400
const LEVELS = [
  { value: 'debug', label: 'All' },
  { value: 'info', label: 'Info' },
  { value: 'warning', label: 'Warnings' },
  { value: 'error', label: 'Errors' },
]

export function EventLog({ of }: { of?: string }) {
  const log = useLive((s) => s.log)
  const dropped = useLive((s) => s.dropped)
  const [level, setLevel] = useState<Level>('info')
  const [text, setText] = useState('')
  const [follows, setFollows] = useState(true)
  const lines = useMemo(() => passing(log, { level, text, path: '' }), [log, level, text])
  const shown = lines.slice(-SHOWN)
  const hidden = lines.length - shown.length + dropped
  const { ref, width } = useElementSize()

  const tools = (
    <Group ref={ref} flex={1} miw={0} gap="xs" justify="flex-end" wrap="nowrap">
      <TextInput
        size="xs"
        aria-label="Find in the log"
        placeholder="Find"
        leftSection={<IconSearch size={14} aria-hidden />}
        rightSection={text && <CloseButton size="xs" aria-label="Clear" onClick={() => setText('')} />}
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
        flex="0 1 180px"
        miw={70}
      />
      <SegmentedControl
        size="xs"
        aria-label="Least level shown"
        data={LEVELS}
        value={level}
        onChange={(value) => setLevel(value as Level)}
      />
      <Switch
        size="xs"
        label={width > 430 ? 'Follow' : undefined}
        aria-label="Follow the newest line"
        checked={follows}
        onChange={(event) => setFollows(event.currentTarget.checked)}
      />
    </Group>
  )

  return (
    <Panel title="Event log" of={of} tools={tools} className={classes.panel ?? ''}>
      <Lines lines={shown} follows={follows} onLeave={() => setFollows(false)} hidden={hidden} isFiltered={log.length > 0} />
    </Panel>
  )
}

interface LinesProps {
  readonly lines: readonly LogLine[]
  readonly hidden: number
  readonly isFiltered: boolean
  readonly follows: boolean
  readonly onLeave: () => void
}

function Lines({ lines, hidden, isFiltered, follows, onLeave }: LinesProps) {
  const area = useRef<HTMLDivElement>(null)
  const last = lines[lines.length - 1]?.seq

  useEffect(() => {
    if (follows && area.current) area.current.scrollTop = area.current.scrollHeight
  }, [follows, last])

  return (
    <Box
      className="pane"
      py={4}
      fz="0.8rem"
      role="log"
      aria-label="Events"
      aria-live="off"
      tabIndex={0}
      ref={area}
      onWheel={(e) => e.deltaY < 0 && follows && onLeave()}
    >
      {lines.length === 0 && (
        <Empty
          icon={<IconListDetails size={26} stroke={1.4} aria-hidden />}
          title={isFiltered ? 'No line matches' : 'Nothing has happened yet'}
        >
          {isFiltered ? 'Show all levels, or clear the search.' : 'Start the behavior; its events appear here.'}
        </Empty>
      )}
      {hidden > 0 && (
        <Text inherit px={14} py={2} c="var(--quiet)">
          {hidden} earlier lines are in the journal
        </Text>
      )}
      {lines.map((line) => (
        <Line key={line.seq} line={line} />
      ))}
    </Box>
  )
}

/** What was unfolded at the lower edge is moved into view. */
function intoView(element: HTMLElement | null): void {
  element?.scrollIntoView({ block: 'nearest' })
}

const Line = memo(function Line({ line }: { line: LogLine }) {
  const [open, setOpen] = useState(false)
  const hasCause = line.causes.length > 0
  const Chevron = open ? IconChevronDown : IconChevronRight
  const words = line.causes.length === 1 ? 'cause' : `${line.causes.length} causes`
  return (
    <div className={classes.line} data-level={line.level}>
      <span>{line.time_s.toFixed(3)}</span>
      <span className={classes.level}>{line.level}</span>
      <span className="cut-text">{line.path || 'run'}</span>
      <span className={classes.text}>
        {line.text}
        {hasCause && (
          <Button
            variant="default"
            size="compact-xs"
            h="1.25rem"
            ml="2xs"
            leftSection={<Chevron size={13} aria-hidden />}
            styles={{ section: { marginInlineEnd: 2 } }}
            aria-expanded={open}
            aria-label={`${words}: ${line.text}, ${line.time_s.toFixed(3)} s`}
            onClick={() => setOpen(!open)}
          >
            {words}
          </Button>
        )}
        {open && (
          <Box component="ol" my="4xs" pl={18} c="var(--text)" aria-label="Causes" ref={intoView}>
            {line.causes.map((cause, index) => (
              <li key={index}>
                <div>{causeWords(cause)}</div>
                <Text inherit ff="monospace" c="var(--quiet)">
                  {[cause.kind, cause.where].filter(Boolean).join(' · ')}
                </Text>
              </li>
            ))}
          </Box>
        )}
      </span>
    </div>
  )
})

/** The runs of this server, newest first. */
import { List, Text } from '@mantine/core'
import { useLive } from '../../api/live'
import type { RunView } from '../../api/types'
import { Empty } from '../../components/Empty'
import { SideLink } from '../../components/SideLink'
import { StatusIcon } from '../../components/StatusIcon'
import { isActive, runStateOf, runWords } from '../../document/runState'
import { duration, startTime } from '../../document/time'
import { fileTitle } from '../../document/path'

export interface RunListProps {
  readonly current: string | undefined
  readonly href: (run: string) => string
  readonly onOpen: (run: string) => void
  readonly limit: number
}

export function RunList({ current, href, onOpen, limit }: RunListProps) {
  const runs = useLive((s) => s.runs)
  const isKnown = useLive((s) => s.epoch !== '')
  return (
    <nav aria-label="Runs">
      <Text component="h2" fz="0.75rem" fw={600} mx="2xs" mb="2xs" c="dimmed">
        Runs
      </Text>
      {isKnown && runs.length === 0 && <Empty title="No runs yet">Choose a behavior and start it.</Empty>}
      <List listStyleType="none">
        {runs.slice(0, limit).map((run) => (
          <li key={run.id}>
            <SideLink
              href={href(run.id)}
              isCurrent={run.id === current}
              icon={<StatusIcon status={runStateOf(run).look} size={15} />}
              label={nameOf(run.behavior)}
              description={`${startTime(run, runs)} · ${runText(run)}`}
              onOpen={() => onOpen(run.id)}
            />
          </li>
        ))}
      </List>
    </nav>
  )
}

function runText(run: RunView): string {
  return isActive(run) ? runWords(run) : `${runWords(run)}, ${duration(run.duration_s).replace(' ', '\u00a0')}`
}

/** The file name without its ending. */
export function nameOf(behavior: string): string {
  return fileTitle(behavior)
}

/** The behaviors of the project, to choose one. */
import { Box, CloseButton, Group, Text, TextInput, Title } from '@mantine/core'
import { IconSearch } from '@tabler/icons-react'
import { useState } from 'react'
import { useLive } from '../../api/live'
import type { BehaviorSummary } from '../../api/types'
import { Empty } from '../../components/Empty'
import { SideLink } from '../../components/SideLink'
import { StatusIcon } from '../../components/StatusIcon'
import { isActive } from '../../document/runState'
import { parentPath } from '../../document/path'
import classes from './BehaviorList.module.css'
import { NewBehavior } from './NewBehavior'

export interface BehaviorListProps {
  /** Undefined until the server has told them. */
  readonly behaviors: readonly BehaviorSummary[] | undefined
  readonly current: string | undefined
  readonly href: (id: string) => string
  readonly onOpen: (id: string) => void
  /** A new behavior was made; undefined for those who may look only. */
  readonly onMade: ((id: string) => void) | undefined
}

export function BehaviorList({ behaviors, current, href, onOpen, onMade }: BehaviorListProps) {
  const [text, setText] = useState('')
  const runs = useLive((s) => s.runs)
  const active = new Set(runs.filter(isActive).map((run) => run.behavior))
  const query = text.trim().toLowerCase()
  const found = (behaviors ?? []).filter((b) => `${b.id} ${b.name} ${b.description}`.toLowerCase().includes(query))
  const others = found.filter((behavior) => !fits(behavior))
  return (
    <nav aria-label="Behaviors">
      <Group justify="space-between" mb="3xs">
        <Title order={2} fz="xs" px="2xs" c="var(--quiet)">
          Behaviors
        </Title>
        {onMade && <NewBehavior onMade={onMade} />}
      </Group>
      <TextInput
        size="xs"
        mb="2xs"
        aria-label="Find a behavior"
        placeholder="Find"
        leftSection={<IconSearch size={14} aria-hidden />}
        rightSection={text && <CloseButton size="xs" aria-label="Clear" onClick={() => setText('')} />}
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
      />
      {behaviors && found.length === 0 && (
        <Empty title={behaviors.length === 0 ? 'No behaviors' : 'None matches'}>
          {behaviors.length === 0 ? 'Put a YAML document below behaviors/.' : 'Try another word.'}
        </Empty>
      )}
      <ul className="plain-list">
        {found.filter(fits).map((behavior) => (
          <Item key={behavior.id} {...{ behavior, current, href, onOpen }} isRunning={active.has(behavior.id)} />
        ))}
      </ul>
      {others.length > 0 && (
        <Box component="details" mt="sm" open={query !== '' || others.some((behavior) => behavior.id === current)}>
          <Text component="summary" size="sm" px="2xs" py="4xs" c="var(--quiet)" style={{ cursor: 'pointer' }}>
            Of other cells ({others.length})
          </Text>
          <Text size="xs" px="2xs" c="var(--quiet)">
            They cannot be started in this cell; open one to adapt it.
          </Text>
          <ul className="plain-list">
            {others.map((behavior) => (
              <Item key={behavior.id} {...{ behavior, current, href, onOpen }} isRunning={false} />
            ))}
          </ul>
        </Box>
      )}
    </nav>
  )
}

function fits(behavior: BehaviorSummary): boolean {
  return behavior.fit.obstacle === ''
}

interface ItemProps extends Pick<BehaviorListProps, 'current' | 'href' | 'onOpen'> {
  readonly behavior: BehaviorSummary
  readonly isRunning: boolean
}

function Item({ behavior, current, href, onOpen, isRunning }: ItemProps) {
  return (
    <li>
      <SideLink
        href={href(behavior.id)}
        isCurrent={behavior.id === current}
        title={behavior.fit.obstacle || undefined}
        onOpen={() => onOpen(behavior.id)}
        label={
          <Group component="span" gap="2xs" wrap="nowrap">
            {behavior.name}
            {isRunning && <span className={classes.live} role="img" aria-label="active" />}
          </Group>
        }
        description={
          <>
            <Text span inherit truncate display="block">
              {fits(behavior) ? folderOf(behavior.id) : `cell ${behavior.fit.cell}`}
            </Text>
            {behavior.errors > 0 && <Count status="failed" count={behavior.errors} word="error" />}
            {behavior.warnings > 0 && <Count status="warning" count={behavior.warnings} word="warning" />}
          </>
        }
      />
    </li>
  )
}

function Count({ status, count, word }: { status: 'failed' | 'warning'; count: number; word: string }) {
  return (
    <Group component="span" display="inline-flex" gap="4xs" mr="xs" fw={600} c="var(--status)" data-status={status}>
      <StatusIcon status={status} size={12} />
      {count} {word}
      {count === 1 ? '' : 's'}
    </Group>
  )
}

function folderOf(id: string): string {
  const folder = parentPath(id)
  return folder.replace(/^behaviors\/?/, '') || 'behaviors'
}

/** The entries of one kind, grouped by namespace; topics with their rate and the age of their latest message. */
import { Box, Group, List, Title, UnstyledButton } from '@mantine/core'
import { lookup, type Dict } from '../../document/dict'
import { memo, useMemo } from 'react'
import { byNamespace, type Named } from '../../document/busTree'
import { nameOfPath } from '../../document/path'
import { ageText, rateText } from './words'
import type { TopicMetrics } from '../../api/types'
import classes from './bus.module.css'

interface EntryListProps {
  readonly entries: readonly Named[]
  readonly kind: string
  readonly chosen: string | undefined
  readonly onChoose: (name: string) => void
  readonly traffic: Dict<TopicMetrics> | undefined
}

export function EntryList({ entries, kind, chosen, onChoose, traffic }: EntryListProps) {
  const groups = useMemo(() => byNamespace(entries), [entries])
  const isTopics = kind === 'topics'
  return (
    <nav className={classes.list} aria-label={`The ${kind} of the bus`}>
      {isTopics && (
        <Group
          pos="sticky"
          top={0}
          gap="2xs"
          px="sm"
          py={3}
          wrap="nowrap"
          bg="var(--surface)"
          fz="0.72rem"
          c="dimmed"
          style={{ zIndex: 1 }}
          aria-hidden
        >
          <Box component="span" flex={1}>
            Topic
          </Box>
          <span className={classes.figure}>Rate</span>
          <span className={classes.figure}>Latest</span>
        </Group>
      )}
      {groups.map((group) => (
        <section key={group.name} aria-label={group.name || 'Without a namespace'}>
          <Title order={3} px="sm" pt="4xs" pb={2} fz="0.74rem" fw={620} c="dimmed">
            {group.name || 'without a namespace'}
          </Title>
          <List listStyleType="none" fz="inherit">
            {group.entries.map((entry) => (
              <Row
                key={entry.name}
                name={entry.name}
                type={entry.type}
                isChosen={entry.name === chosen}
                onChoose={onChoose}
                rate={isTopics ? rateText(lookup(traffic, entry.name)) : undefined}
                age={isTopics ? ageText(lookup(traffic, entry.name)) : undefined}
              />
            ))}
          </List>
        </section>
      ))}
    </nav>
  )
}

interface RowProps {
  readonly name: string
  readonly type: string
  readonly isChosen: boolean
  readonly onChoose: (name: string) => void
  readonly rate: string | undefined
  readonly age: string | undefined
}

/** Drawn again only when its own words change. */
const Row = memo(
  function Row({ name, type, isChosen, onChoose, rate, age }: RowProps) {
    return (
      <li>
        <UnstyledButton className={`${classes.row} pick-row`} aria-current={isChosen} onClick={() => onChoose(name)}>
          <span className={`${classes.name} cut-text`}>{nameOfPath(name)}</span>
          <Box component="span" flex={1} className="cut-text">
            {type}
          </Box>
          {rate !== undefined && <span className={classes.figure}>{rate}</span>}
          {age !== undefined && <span className={classes.figure}>{age}</span>}
        </UnstyledButton>
      </li>
    )
  },
  (before, after) =>
    before.name === after.name &&
    before.type === after.type &&
    before.isChosen === after.isChosen &&
    before.rate === after.rate &&
    before.age === after.age,
)

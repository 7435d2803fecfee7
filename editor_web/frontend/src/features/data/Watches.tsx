/** The watches of a behavior: expressions with their values now or at the moment of the past, edited in place. */
import { ActionIcon, Badge, Group, List, Text, Title, UnstyledButton } from '@mantine/core'
import { IconTrash } from '@tabler/icons-react'
import { useState } from 'react'
import type { Watch, WatchValue } from '../../api/types'
import { replaceWatch, useWatches, watchValueOf } from '../../api/watches'
import { ExpressionInput } from '../../components/ExpressionInput'
import { ValueTree } from '../../components/ValueTree'
import { nameOfPath } from '../../document/path'
import { inShort, isShort } from '../../document/values'
import classes from './data.module.css'

export interface WatchesProps {
  readonly behavior: string
  /** In the order of the watches; shorter while the server has not answered. */
  readonly values: readonly WatchValue[]
  readonly names: readonly string[]
  /** The selected node, at which a new watch is read. */
  readonly node: string | undefined
}

export function Watches({ behavior, values, names, node }: WatchesProps) {
  const watches = useWatches(behavior)
  const [edited, edit] = useState<Watch>()
  const [added, setAdded] = useState(0)
  const at = node && node !== 'root' ? node : ''
  return (
    <section aria-label="Watches">
      <Title order={3} bg="var(--surface)" px="sm" py="4xs" fz="0.76rem" fw={620} c="dimmed">
        Watches
      </Title>
      <List listStyleType="none" fz="inherit">
        {watches.map((watch, index) => (
          <li key={`${watch.path ?? ''} ${watch.expression}`} className={classes.line}>
            {edited === watch ? (
              <ExpressionInput
                isFocused
                isLabelHidden
                label={`Expression of the watch ${watch.expression}`}
                value={watch.expression}
                names={names}
                onCommit={(text) => {
                  edit(undefined)
                  if (text !== watch.expression) replaceWatch(behavior, watch, text ? { ...watch, expression: text } : undefined)
                }}
                onCancel={() => edit(undefined)}
              />
            ) : (
              <UnstyledButton
                ff="monospace"
                fz="inherit"
                fw={600}
                ta="start"
                title="Edit it"
                aria-label={`Edit the watch ${watch.expression}`}
                onClick={() => edit(watch)}
              >
                {watch.expression}
              </UnstyledButton>
            )}
            <Value name={watch.expression} value={values[index]} />
            <Group gap="2xs" wrap="nowrap" justify="space-between">
              {watch.path ? (
                <Badge variant="default" size="xs" tt="none" title={`As the node ${watch.path} reads it`}>
                  at {nameOfPath(watch.path)}
                </Badge>
              ) : (
                <span />
              )}
              <ActionIcon
                variant="subtle"
                color="gray"
                size={22}
                aria-label={`Remove the watch ${watch.expression}`}
                title="Remove"
                onClick={() => replaceWatch(behavior, watch)}
              >
                <IconTrash size={14} aria-hidden />
              </ActionIcon>
            </Group>
          </li>
        ))}
      </List>
      <Group px="sm" py="4xs" gap="xs" wrap="nowrap">
        <ExpressionInput
          key={added}
          isLabelHidden
          isFocused={added > 0}
          label="New watch"
          placeholder={
            at ? `Watch an expression at ${nameOfPath(at)}, for example tries > 1` : 'Watch an expression, for example tries > 1'
          }
          value=""
          names={names}
          onCommit={(text) => {
            if (!text) return
            watchValueOf(behavior, { expression: text, ...(at && { path: at }) })
            setAdded(added + 1)
          }}
        />
      </Group>
    </section>
  )
}

function Value({ name, value }: { name: string; value: WatchValue | undefined }) {
  if (!value) return <span />
  if (value.problem) {
    return (
      <Text span inherit c="var(--stopped)">
        {value.problem}
      </Text>
    )
  }
  return isShort(value.value) ? (
    <Text span inherit ff="monospace" className={classes.value} key={inShort(value.value)} data-written>
      {inShort(value.value)}
    </Text>
  ) : (
    <ValueTree label={`Value of ${name}`} value={value.value} open={0} />
  )
}

/** What can be done with the selected node: why it waits, breakpoints, lock, forced outcomes, run again. */
import { Group, Text, TextInput, Title } from '@mantine/core'
import { IconLock, IconLockOpen, IconPlayerPause, IconPlayerSkipForward, IconRepeat } from '@tabler/icons-react'
import { useState } from 'react'
import { useLive } from '../../api/live'
import { askStartHere } from '../../api/startHere'
import type { GraphNode } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { GoalLine } from '../../components/GoalLine'
import { waitingWords } from '../../document/commands'
import { lookup } from '../../document/dict'
import { Breakpoints } from './Breakpoints'
import classes from './NodeCard.module.css'
import type { Commands } from './useCommands'

/** Where the key `f` goes. */
export const FORCE_ID = 'force'

export function NodeCard({ node, behavior, commands }: { node: GraphNode; behavior: string; commands: Commands }) {
  const waiting = useLive((s) => s.control?.waiting.find((each) => each.path === node.path))
  const forced = { obstacle: commands.obstacle('force'), onObstacle: () => commands.explain('force', 'Force') }
  return (
    <section className={classes.card} aria-label={`Node ${node.path}`}>
      <Text size="sm" ff="monospace" fw={620} className={classes.wide} style={{ overflowWrap: 'anywhere' }}>
        {node.path}
      </Text>
      <div className={classes.wide}>
        <GoalLine path={node.path} />
      </div>
      {waiting && (
        <Text size="sm" px="xs" py="3xs" bg="var(--stopped-soft)" bdrs="md" className={classes.wide}>
          <strong>Waits</strong> {waitingWords(waiting)}
        </Text>
      )}
      <Part name="Start" />
      <Group gap="3xs">
        <CommandButton
          label="Run from here…"
          hint="Start a run at this node, with the data of the last run that entered it"
          icon={<IconPlayerSkipForward size={16} aria-hidden />}
          obstacle={obstacleHere(node)}
          onPress={() => askStartHere({ behavior, path: node.path, kind: 'from' })}
        />
        <CommandButton
          label="Run to here…"
          hint="Pause once before this node"
          icon={<IconPlayerPause size={16} aria-hidden />}
          obstacle={obstacleHere(node)}
          onPress={() => askStartHere({ behavior, path: node.path, kind: 'to' })}
        />
      </Group>
      <Part name="Break" />
      <Breakpoints key={node.path} place="node" path={node.path} isOff={commands.obstacle('breakpoint')} />
      <Part name="Lock" />
      <Lock key={`${node.path} lock`} path={node.path} commands={commands} />
      <Part name="Force" />
      <Group gap="3xs" id={FORCE_ID} role="group" aria-label="Force an outcome">
        {node.outcomes.map((outcome) => (
          <CommandButton
            key={outcome}
            {...forced}
            label={outcome}
            hint={`End it with ${outcome}; what runs in it is preempted and cleans up first`}
            onPress={() => void commands.force(node.path, outcome)}
          />
        ))}
      </Group>
      <Part name="Repeat" />
      <Group gap="3xs">
        <CommandButton
          label="Run again"
          hint="Its active children are preempted and clean up first"
          icon={<IconRepeat size={16} aria-hidden />}
          command="repeat"
          obstacle={commands.obstacle('repeat')}
          onObstacle={() => commands.explain('repeat', 'Run again')}
          onPress={() => void commands.repeat(node.path)}
        />
      </Group>
    </section>
  )
}

function obstacleHere(node: GraphNode): string | undefined {
  if (node.path === 'root') return 'this is the beginning'
  return node.disabled === false ? undefined : 'it is disabled, so no run enters it'
}

function Lock({ path, commands }: { path: string; commands: Commands }) {
  const isLocked = useLive((s) => s.control?.locks.includes(path) ?? false)
  const given = useLive((s) => lookup(s.lockReasons, path))
  const [reason, setReason] = useState('')
  const common = { obstacle: commands.obstacle('lock'), onObstacle: () => commands.explain('lock', 'Lock'), command: 'lock' as const }
  if (isLocked) {
    return (
      <Group gap="3xs">
        <CommandButton
          {...common}
          label="Unlock"
          icon={<IconLockOpen size={16} aria-hidden />}
          onPress={() => void commands.unlock(path)}
        />
        <Text span size="sm" c="var(--quiet)">
          {given ? `Locked: ${given}` : 'Locked without a reason given'}
        </Text>
      </Group>
    )
  }
  return (
    <Group gap="3xs">
      <TextInput
        size="xs"
        aria-label="Reason of the lock"
        placeholder="Reason"
        maxLength={200}
        value={reason}
        onChange={(event) => setReason(event.currentTarget.value)}
        flex={1}
      />
      <CommandButton
        {...common}
        label="Lock"
        hint="Hold the outcome of this node until it is unlocked; transitions inside it still pass"
        icon={<IconLock size={16} aria-hidden />}
        onPress={() => void commands.lock(path, reason.trim()).then(() => setReason(''))}
      />
    </Group>
  )
}

function Part({ name }: { readonly name: string }) {
  return (
    <Title order={3} fz="0.78rem" fw={620} c="var(--quiet)" my={6}>
      {name}
    </Title>
  )
}

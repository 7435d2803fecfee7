/** The arms of the cell: what each does, how fast it may, and out of a reflex again. */
import { Box, Group, Text } from '@mantine/core'
import { lookup } from '../../document/dict'
import { IconRobot } from '@tabler/icons-react'
import { useState } from 'react'
import { api, wordsOf } from '../../api/client'
import { useLive } from '../../api/live'
import type { RobotLive } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { CommitSlider } from '../../components/CommitSlider'
import { StatusIcon } from '../../components/StatusIcon'
import { modeWords, robotLook } from '../../document/robotMode'
import type { Status } from '../../document/runState'

const EDGES: Partial<Record<Status, string>> = { failed: 'var(--failed)', active: 'var(--active)' }

export function RobotStrip() {
  const robots = useLive((s) => s.robots)
  const names = Object.keys(robots).toSorted()
  if (names.length === 0) return null
  return (
    <Box component="ul" className="plain-list" flex="none" mah="45%" style={{ overflow: 'auto' }} aria-label="Arms">
      {names.map((name) => {
        const robot = lookup(robots, name)
        return robot && <Robot key={name} robot={robot} />
      })}
    </Box>
  )
}

function Robot({ robot }: { robot: RobotLive }) {
  const isConnected = useLive((s) => s.connection === 'live')
  const role = useLive((s) => s.role)
  const [problem, setProblem] = useState('')
  const { name, mode, activity, error, separation, speed_override: share } = robot
  const look = robotLook(mode)
  const obstacle = !isConnected ? 'the server does not answer' : role === 'operator' ? undefined : 'you may look only'

  async function attempt(request: () => Promise<unknown>): Promise<boolean> {
    try {
      await request()
      setProblem('')
      return true
    } catch (refused) {
      setProblem(wordsOf(refused))
      return false
    }
  }

  return (
    <Group
      component="li"
      gap="4xs"
      px="sm"
      py={5}
      fz="0.84rem"
      bg={look === 'failed' ? 'var(--failed-soft)' : 'none'}
      style={{
        '--label': look === 'failed' ? 'var(--text)' : 'var(--quiet)',
        columnGap: 14,
        borderTop: '1px solid var(--line)',
        borderInlineStart: `4px solid ${EDGES[look] ?? 'transparent'}`,
      }}
      data-status={look}
      aria-label={`Arm ${name}`}
    >
      <Group component="span" gap="3xs" miw="5em" fw={620}>
        <IconRobot size={16} aria-hidden />
        {name}
      </Group>
      <Group component="span" gap="3xs" flex="1 1 8em" role="status" aria-label={`State of ${name}`}>
        <StatusIcon status={look} size={14} />
        {modeWords(robot)}
        {activity && (
          <Text span inherit c="var(--label)">
            {activity}
          </Text>
        )}
        {separation && (
          <Text span inherit c="var(--label)">
            {separation}
          </Text>
        )}
      </Group>
      <CommitSlider
        label="Speed"
        of={name}
        min={5}
        max={100}
        step={5}
        value={Math.round(share * 100)}
        words={(percent) => `${percent} %`}
        hint="Speed of all motions as a fraction of their own speed, including the active one"
        obstacle={obstacle}
        onCommit={(percent) => attempt(() => api.setSpeed(name, percent / 100))}
      />
      {(mode === 'reflex' || mode === 'fault') && (
        <CommandButton
          label="Recover"
          hint="Check the arm first. It then holds its position and accepts goals again"
          tone="strong"
          obstacle={obstacle}
          onPress={() => void attempt(() => api.recover(name))}
        />
      )}
      {error && <Problem>{error}</Problem>}
      {problem && <Problem isNew>{problem}</Problem>}
    </Group>
  )
}

function Problem({ children, isNew = false }: { readonly children: string; readonly isNew?: boolean }) {
  return (
    <Text span inherit flex="1 0 100%" c="var(--failed)" style={{ overflowWrap: 'anywhere' }} {...(isNew ? { role: 'alert' } : {})}>
      {children}
    </Text>
  )
}

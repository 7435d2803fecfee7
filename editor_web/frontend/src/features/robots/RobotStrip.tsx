/** The arms of the cell: what each does, how fast it may, and out of a reflex again. */
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

export function RobotStrip() {
  const robots = useLive((s) => s.robots)
  const names = Object.keys(robots).toSorted()
  if (names.length === 0) return null
  return (
    <ul className="plain-list robots" aria-label="Arms">
      {names.map((name) => {
        const robot = lookup(robots, name)
        return robot && <Robot key={name} robot={robot} />
      })}
    </ul>
  )
}

function Robot({ robot }: { robot: RobotLive }) {
  const isConnected = useLive((s) => s.connection === 'live')
  const role = useLive((s) => s.role)
  const [problem, setProblem] = useState('')
  const { name, mode, activity, error, speed_override: share } = robot
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
    <li className={`robot is-${look}`} aria-label={`Arm ${name}`}>
      <span className="robot-name">
        <IconRobot size={16} aria-hidden />
        {name}
      </span>
      <span className="robot-mode" role="status" aria-label={`State of ${name}`}>
        <StatusIcon status={look} size={14} />
        {modeWords(robot)}
        {activity && <span className="quiet">{activity}</span>}
      </span>
      <CommitSlider
        label="Speed"
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
      {error && <span className="robot-error">{error}</span>}
      {problem && (
        <span className="robot-error" role="alert">
          {problem}
        </span>
      )}
    </li>
  )
}

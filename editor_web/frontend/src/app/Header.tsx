/** The bar on top: where one is, whether it is live, the running behavior and its stop button. */
import { ActionIcon, Button, Tooltip, useComputedColorScheme, useMantineColorScheme } from '@mantine/core'
import { IconHandFinger, IconMoon, IconPlayerStopFilled, IconSun } from '@tabler/icons-react'
import { useState } from 'react'
import { api } from '../api/client'
import { useLive } from '../api/live'
import type { RunLine } from '../api/types'
import { StatusIcon } from '../components/StatusIcon'
import { nameOf, RunTime } from '../features/runs/RunList'
import { TEACH_HREF } from './route'

export interface HeaderProps {
  readonly cellName: string
  readonly mayOperate: boolean
  /** The run under way that is shown, else any. */
  readonly active: RunLine | undefined
  /** How many more are under way. */
  readonly others: number
  readonly onHome: () => void
  readonly isTeaching: boolean
  readonly onTeach: () => void
  readonly onRun: (id: string) => void
}

export function Header({ cellName, mayOperate, active, others, onHome, isTeaching, onTeach, onRun }: HeaderProps) {
  return (
    <>
      <a
        href="/"
        className="brand"
        onClick={(event) => {
          event.preventDefault()
          onHome()
        }}
      >
        <img src="/favicon.svg" alt="" width={24} height={24} />
        <span className="brand-name">flexcell</span>
      </a>
      {cellName && <span className="cell-name">{cellName}</span>}
      <a
        href={TEACH_HREF}
        className="header-link"
        aria-current={isTeaching ? 'page' : undefined}
        onClick={(event) => {
          if (event.metaKey || event.ctrlKey || event.shiftKey || event.button !== 0) return
          event.preventDefault()
          onTeach()
        }}
      >
        <IconHandFinger size={16} aria-hidden />
        Teach
      </a>
      <ConnectionLabel />
      <span className="spacer" />
      {active && (
        <div className="active-run">
          <button type="button" className="active-run-name" onClick={() => onRun(active.id)}>
            <StatusIcon status={active.status === 'stopping' ? 'stopped' : 'active'} size={14} />
            <span>{nameOf(active.behavior)}</span>
          </button>
          <RunTime run={active} />
          {others > 0 && <span>+ {others}</span>}
        </div>
      )}
      {active && mayOperate && <StopButton run={active} />}
      <SchemeSwitch />
    </>
  )
}

function StopButton({ run }: { run: RunLine }) {
  const [problem, setProblem] = useState<string>()
  const isStopping = run.status === 'stopping'
  const isConnected = useLive((s) => s.connection === 'live')
  return (
    <Tooltip label={isConnected ? (problem ?? 'The robots decelerate to rest') : 'Not possible: the server does not answer'}>
      <Button
        color="red.8"
        size="xs"
        leftSection={<IconPlayerStopFilled size={14} aria-hidden />}
        disabled={isStopping || !isConnected}
        onClick={() => {
          api.stop(run.id).then(
            () => setProblem(undefined),
            (error: unknown) => setProblem(String(error)),
          )
        }}
      >
        {isStopping ? 'Stopping' : 'Stop'}
      </Button>
    </Tooltip>
  )
}

const WORDS = { connecting: 'Connecting', live: 'Live', lost: 'Reconnecting', denied: 'Logged out' }

function ConnectionLabel() {
  const connection = useLive((s) => s.connection)
  return (
    <span className={`connection is-${connection}`} role="status">
      <span className="connection-dot" aria-hidden />
      {WORDS[connection]}
    </span>
  )
}

function SchemeSwitch() {
  const { setColorScheme } = useMantineColorScheme()
  const scheme = useComputedColorScheme('light')
  const next = scheme === 'dark' ? 'light' : 'dark'
  return (
    <Tooltip label={`Use the ${next} theme`}>
      <ActionIcon variant="subtle" color="gray" size="lg" aria-label={`Use the ${next} theme`} onClick={() => setColorScheme(next)}>
        {scheme === 'dark' ? <IconSun size={18} /> : <IconMoon size={18} />}
      </ActionIcon>
    </Tooltip>
  )
}

/** The bar on top: where one is, whether it is live, the running behavior and its stop button. */
import { ActionIcon, Button, Tooltip, useComputedColorScheme, useMantineColorScheme } from '@mantine/core'
import { IconHandFinger, IconMoon, IconPlayerStopFilled, IconSun } from '@tabler/icons-react'
import { useState } from 'react'
import { api } from '../api/client'
import { useLive } from '../api/live'
import type { RunView } from '../api/types'
import { PageLink } from '../components/PageLink'
import { StatusIcon } from '../components/StatusIcon'
import { runStateOf, runWords } from '../document/runState'
import { nameOf, RunTime } from '../features/runs/RunList'
import { CELL_HREF, RUNS_HREF, TEACH_HREF } from './route'

export interface HeaderProps {
  readonly cellName: string
  readonly mayOperate: boolean
  /** The run of the page. */
  readonly shown: RunView | undefined
  /** The runs under way. */
  readonly active: readonly RunView[]
  readonly onHome: () => void
  readonly isCell: boolean
  readonly onCell: () => void
  readonly isTeaching: boolean
  readonly onTeach: () => void
  readonly onRun: (id: string) => void
  readonly onRuns: () => void
}

export function Header({ cellName, mayOperate, shown, active, onHome, isCell, onCell, isTeaching, onTeach, onRun, onRuns }: HeaderProps) {
  // Of several it is the one of the page, or none: nobody is to stop a run that was not meant.
  const named = active.find((run) => run.id === shown?.id) ?? (active.length === 1 ? active[0] : undefined)
  const others = active.length - 1
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
      {cellName && (
        <PageLink href={CELL_HREF} className="cell-name" title="What the cell consists of" isCurrent={isCell} onOpen={onCell}>
          {cellName}
        </PageLink>
      )}
      <PageLink href={TEACH_HREF} className="header-link" isCurrent={isTeaching} onOpen={onTeach}>
        <IconHandFinger size={16} aria-hidden />
        <span className="header-link-words">Teach</span>
      </PageLink>
      <ConnectionLabel />
      <span className="spacer" />
      {!named && active.length > 1 && (
        <PageLink href={RUNS_HREF} className="active-run" onOpen={onRuns}>
          <StatusIcon status="active" size={14} />
          <span>
            {active.length} runs<span className="active-run-words"> active</span>
          </span>
        </PageLink>
      )}
      {named && (
        <div className={`active-run is-${runStateOf(named).look}`}>
          <button type="button" className="active-run-name" title={runWords(named)} onClick={() => onRun(named.id)}>
            <StatusIcon status={runStateOf(named).look} size={14} />
            <span>{nameOf(named.behavior)}</span>
          </button>
          <RunTime run={named} />
          {others > 0 && (
            <PageLink href={RUNS_HREF} className="active-run-others" title="All active runs" onOpen={onRuns}>
              + {others}
              <span className="active-run-words"> other{others > 1 && 's'}</span>
            </PageLink>
          )}
        </div>
      )}
      {named && mayOperate && <StopButton run={named} />}
      <SchemeSwitch />
    </>
  )
}

function StopButton({ run }: { run: RunView }) {
  const [problem, setProblem] = useState<string>()
  const isStopping = run.status === 'stopping'
  const isConnected = useLive((s) => s.connection === 'live')
  return (
    <Tooltip
      label={isConnected ? (problem ?? 'The robots decelerate to rest') : 'Not possible: the server does not answer. Stop the cell works'}
    >
      <Button
        variant="default"
        size="xs"
        aria-label={isStopping ? 'This run is stopping' : 'Stop this run'}
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
        <span className="active-run-words">&nbsp;{isStopping ? '' : 'this run'}</span>
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

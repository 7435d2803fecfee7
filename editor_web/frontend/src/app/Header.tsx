/** The bar on top: where one is, whether it is live, the running behavior and its stop button. */
import { ActionIcon, Badge, Box, Button, Group, Text, UnstyledButton, useComputedColorScheme, useMantineColorScheme } from '@mantine/core'
import { IconHandFinger, IconMoon, IconPlayerStopFilled, IconPlugConnected, IconSun } from '@tabler/icons-react'
import { useState, type MouseEvent } from 'react'
import { api } from '../api/client'
import { useLive } from '../api/live'
import type { RunView } from '../api/types'
import { WhileLoading, lazyView } from '../components/lazyView'
import { PageLink } from '../components/PageLink'
import { StatusIcon } from '../components/StatusIcon'
import { runStateOf, runWords } from '../document/runState'
import { RunTime } from '../components/RunTime'
import { nameOf } from '../features/runs/RunList'
import classes from './Header.module.css'
import { CELL_HREF, RUNS_HREF, TEACH_HREF } from './route'

const People = lazyView(async () => (await import('../features/presence/People')).People)

/** The room of one person, kept free until it is known who is there. */
const OWN_PX = 26

export interface HeaderProps {
  readonly cellName: string
  /** Which devices are real; empty for a cell without drivers. */
  readonly devices: string
  /** Is it known which cell this is, and what one may do? */
  readonly isKnown: boolean
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

export function Header({
  cellName,
  devices,
  isKnown,
  mayOperate,
  shown,
  active,
  onHome,
  isCell,
  onCell,
  isTeaching,
  onTeach,
  onRun,
  onRuns,
}: HeaderProps) {
  // Of several it is the one of the page, or none: nobody is to stop a run that was not meant.
  const named = active.find((run) => run.id === shown?.id) ?? (active.length === 1 ? active[0] : undefined)
  const others = active.length - 1
  return (
    <>
      <Text
        component="a"
        href="/"
        aria-label="flexcell"
        fz="1.02rem"
        fw={650}
        td="none"
        c="var(--text)"
        display="flex"
        style={{ gap: 9, alignItems: 'center' }}
        onClick={(event: MouseEvent) => {
          event.preventDefault()
          onHome()
        }}
      >
        <img src="/favicon.svg" alt="" width={24} height={24} />
        <Text span inherit visibleFrom="xs">
          flexcell
        </Text>
      </Text>
      {cellName && (
        <Box visibleFrom="md" pl="sm" style={{ borderInlineStart: '1px solid var(--line)' }}>
          <PageLink
            href={CELL_HREF}
            className={`${classes.link} pick-row`}
            title="What the cell consists of"
            isCurrent={isCell}
            onOpen={onCell}
          >
            {cellName}
          </PageLink>
        </Box>
      )}
      {devices && (
        <Badge
          variant="outline"
          color={devices.startsWith('Real') ? 'orange' : 'gray'}
          c="var(--text)"
          tt="none"
          flex="0 1 auto"
          miw={0}
          maw="14rem"
          title={devices}
          leftSection={devices.startsWith('Real') ? <IconPlugConnected size={13} aria-hidden /> : undefined}
        >
          {devices}
        </Badge>
      )}
      {isKnown && (
        <PageLink href={TEACH_HREF} className={`${classes.link} pick-row`} isCurrent={isTeaching} label="Teach" onOpen={onTeach}>
          <IconHandFinger size={16} aria-hidden />
          <Text span inherit visibleFrom="xs">
            Teach
          </Text>
        </PageLink>
      )}
      <ConnectionLabel />
      <Box flex={1} />
      {!named && active.length > 1 && (
        <PageLink href={RUNS_HREF} className={classes.run} onOpen={onRuns}>
          <StatusIcon status="active" size={14} />
          <span>
            {active.length} runs{' '}
            <Text span inherit visibleFrom="xs">
              active
            </Text>
          </span>
        </PageLink>
      )}
      {named && (
        <div className={classes.run} data-status={runStateOf(named).look}>
          <UnstyledButton
            display="flex"
            miw={0}
            c="inherit"
            fz="inherit"
            fw="inherit"
            style={{ gap: 6, alignItems: 'center' }}
            title={runWords(named)}
            aria-label={nameOf(named.behavior)}
            onClick={() => onRun(named.id)}
          >
            <StatusIcon status={runStateOf(named).look} size={14} />
            <Text span inherit truncate visibleFrom="xs">
              {nameOf(named.behavior)}
            </Text>
          </UnstyledButton>
          <Text span inherit visibleFrom="xs">
            <RunTime run={named} />
          </Text>
          {others > 0 && (
            <PageLink href={RUNS_HREF} className={classes.link} title="All active runs" onOpen={onRuns}>
              + {others}{' '}
              <Text span inherit visibleFrom="xs">
                other{others > 1 && 's'}
              </Text>
            </PageLink>
          )}
        </div>
      )}
      <Box miw={OWN_PX}>
        <WhileLoading value={null}>
          <People />
        </WhileLoading>
      </Box>
      {named && mayOperate && <StopButton run={named} />}
      {/* On a phone the commands of a run take its place. */}
      <Box {...(named && { visibleFrom: 'xs' })}>
        <SchemeSwitch />
      </Box>
    </>
  )
}

function StopButton({ run }: { run: RunView }) {
  const [problem, setProblem] = useState<string>()
  const isStopping = run.status === 'stopping'
  const isConnected = useLive((s) => s.connection === 'live')
  return (
    <Button
      title={isConnected ? (problem ?? 'The robots decelerate to rest') : 'Not possible: the server does not answer. Stop the cell works'}
      variant="default"
      size="xs"
      flex="none"
      px={{ base: 9, xs: 14 }}
      aria-label={isStopping ? 'This run is stopping' : 'Stop this run'}
      disabled={isStopping || !isConnected}
      onClick={() => {
        api.stop(run.id).then(
          () => setProblem(undefined),
          (error: unknown) => setProblem(String(error)),
        )
      }}
    >
      <IconPlayerStopFilled size={14} aria-hidden />
      <Text span inherit ms="2xs" visibleFrom="xs">
        {isStopping ? 'Stopping' : 'Stop this run'}
      </Text>
    </Button>
  )
}

const WORDS = { connecting: 'Connecting', live: 'Live', lost: 'Reconnecting', denied: 'Logged out' }

const DOTS = { connecting: 'var(--line-strong)', live: 'var(--done)', lost: 'var(--failed)', denied: 'var(--failed)' }

function ConnectionLabel() {
  const connection = useLive((s) => s.connection)
  const isOff = connection === 'lost' || connection === 'denied'
  return (
    <Group
      component="span"
      gap="3xs"
      fz="0.8rem"
      c={isOff ? 'var(--failed)' : 'var(--quiet)'}
      fw={isOff ? 600 : 400}
      {...(connection === 'live' ? { visibleFrom: 'md' } : {})}
      data-connection={connection}
      role="status"
    >
      <Box w={8} h={8} bdrs={isOff ? 1 : 'xl'} bg={DOTS[connection]} style={{ forcedColorAdjust: 'none' }} aria-hidden />
      {WORDS[connection]}
    </Group>
  )
}

function SchemeSwitch() {
  const { setColorScheme } = useMantineColorScheme()
  const scheme = useComputedColorScheme('light')
  const next = scheme === 'dark' ? 'light' : 'dark'
  return (
    <ActionIcon
      title={`Use the ${next} theme`}
      variant="subtle"
      color="gray"
      size="lg"
      aria-label={`Use the ${next} theme`}
      onClick={() => setColorScheme(next)}
    >
      {scheme === 'dark' ? <IconSun size={18} /> : <IconMoon size={18} />}
    </ActionIcon>
  )
}

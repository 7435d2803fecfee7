/** The operator's bar: pause, steps, autonomy, operating, hot change. */
import { Box, Group } from '@mantine/core'
import {
  IconArrowBarDown,
  IconArrowBarUp,
  IconArrowBackUp,
  IconArrowRampRight,
  IconHeadset,
  IconKeyboard,
  IconPlayerPause,
  IconPlayerPlay,
  IconRefreshAlert,
  IconRefreshDot,
} from '@tabler/icons-react'
import { showKeys } from '../../api/keyMap'
import { useLive } from '../../api/live'
import { useOperated } from '../../api/liveStore'
import type { RunView } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { CommitSlider } from '../../components/CommitSlider'
import type { RunCommandId } from '../../document/commandTable'
import { LEVEL_WORDS, LEVELS, type Command } from '../../document/commands'
import classes from './RunBar.module.css'
import type { Commands } from './useCommands'

export interface RunBarProps {
  readonly run: RunView | undefined
  readonly commands: Commands
  /** Whether the keys of the page are for this run. */
  readonly hasKeys?: boolean
  /** What it is the bar of, where there are several. */
  readonly of?: string
}

export function RunBar({ run, commands, hasKeys = false, of = '' }: RunBarProps) {
  const control = useLive((s) => s.control)
  const operated = useOperated()
  const key = (id: RunCommandId) => (hasKeys ? id : undefined)
  const named = (label: string) => (of ? `${label} of ${of}` : label)
  const isHeld = control?.paused === true && !control.stepping
  const isMine = operated === run?.id
  const bar = (command: Command, label: string) => ({
    label,
    obstacle: commands.obstacle(command),
    onObstacle: () => commands.explain(command, label),
    isCompact: true,
  })
  return (
    <section className={classes.bar} aria-label={named('Run control')}>
      <Group gap="3xs" role="toolbar" aria-label={of ? `Commands to ${of}` : 'Commands to the run'}>
        <CommandButton
          {...bar(isHeld ? 'resume' : 'pause', isHeld ? 'Resume' : 'Pause')}
          hint={isHeld ? 'Let every goal and timer go on' : 'Hold every goal and timer; the arms come to rest and keep their goals'}
          icon={isHeld ? <IconPlayerPlay size={16} aria-hidden /> : <IconPlayerPause size={16} aria-hidden />}
          command={key('pause')}
          tone={isHeld ? 'strong' : 'plain'}
          isCompact={false}
          onPress={commands.pauseOrResume}
        />
        <CommandButton
          {...bar('step', 'Step into')}
          hint="Go on to the entry of the next node"
          icon={<IconArrowBarDown size={16} aria-hidden />}
          command={key('into')}
          onPress={() => commands.step('into')}
        />
        <CommandButton
          {...bar('step', 'Step over')}
          hint="Go on past everything inside this node"
          icon={<IconArrowRampRight size={16} aria-hidden />}
          command={key('over')}
          onPress={() => commands.step('over')}
        />
        <CommandButton
          {...bar('step', 'Step out')}
          hint="Go on until the container around it has its outcome"
          icon={<IconArrowBarUp size={16} aria-hidden />}
          command={key('out')}
          onPress={() => commands.step('out')}
        />
        <CommandButton
          {...bar('back', 'Step back')}
          hint="Undo the last started node, and return to before its entry"
          icon={<IconArrowBackUp size={16} aria-hidden />}
          command={key('back')}
          onPress={commands.stepBack}
        />
        <Box w={4} visibleFrom="xs" />
        <CommitSlider
          label="Autonomy"
          min={0}
          max={3}
          step={1}
          value={LEVELS.indexOf(control?.autonomy ?? 'full')}
          words={(index) => LEVELS[index] ?? 'full'}
          hint={LEVELS.map((level) => `${level}: ${LEVEL_WORDS[level]}`).join('\n')}
          obstacle={commands.obstacle('autonomy')}
          onCommit={(index) => commands.setAutonomy(LEVELS[index] ?? 'full')}
        />
        <CommandButton
          {...bar('operate', 'Take control')}
          hint="Be asked for outcomes that are above the autonomy of the run; closing this page is then an operator lost"
          icon={<IconHeadset size={16} aria-hidden />}
          isPressed={isMine}
          onPress={commands.toggleOperating}
        />
        <CommandButton
          {...bar('change', 'Apply changes')}
          hint="Apply the current file, and show the changes"
          icon={<IconRefreshDot size={16} aria-hidden />}
          onPress={() => commands.change(false)}
        />
        <CommandButton
          {...bar('change', 'Apply changes and preempt')}
          hint="Like Apply changes; changed active states are preempted and entered again, removed branches are preempted"
          icon={<IconRefreshAlert size={16} aria-hidden />}
          onPress={() => commands.change(true)}
        />
        {hasKeys && (
          <CommandButton
            label="Keys"
            hint="All keys, and changing them"
            icon={<IconKeyboard size={16} aria-hidden />}
            command="sheet"
            tone="quiet"
            isCompact
            onPress={() => showKeys()}
          />
        )}
      </Group>
    </section>
  )
}

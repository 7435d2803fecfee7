/** The few commands to a run that stands among others: pause or resume, stop, operate. */
import { Group, Stack, Text } from '@mantine/core'
import { IconHeadset, IconPlayerPause, IconPlayerPlay, IconPlayerStopFilled } from '@tabler/icons-react'
import { useLive } from '../../api/live'
import { useOperated } from '../../api/liveStore'
import type { RunView } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { operatorWords } from '../../document/commands'
import type { Commands } from './useCommands'

export function RunButtons({ run, commands, of }: { run: RunView; commands: Commands; of: string }) {
  const control = useLive((s) => s.control)
  const isMine = useOperated() === run.id
  const isHeld = control?.paused === true && !control.stepping
  return (
    <Stack component="footer" gap="2xs" mt="auto">
      <Group gap="3xs" role="group" aria-label={`Commands to ${of}`}>
        <CommandButton
          label={isHeld ? 'Resume' : 'Pause'}
          hint={isHeld ? 'Let every goal and timer go on' : 'Hold every goal and timer; the arms come to rest and keep their goals'}
          icon={isHeld ? <IconPlayerPlay size={16} aria-hidden /> : <IconPlayerPause size={16} aria-hidden />}
          tone={isHeld ? 'strong' : 'plain'}
          obstacle={commands.obstacle(isHeld ? 'resume' : 'pause')}
          onObstacle={() => commands.explain(isHeld ? 'resume' : 'pause', isHeld ? 'Resume' : 'Pause')}
          onPress={commands.pauseOrResume}
        />
        <CommandButton
          label="Take control"
          hint="Be asked for outcomes that are above the autonomy of the run. A page operates one run at a time"
          icon={<IconHeadset size={16} aria-hidden />}
          isPressed={isMine}
          obstacle={commands.obstacle('operate')}
          onObstacle={() => commands.explain('operate', 'Take control')}
          onPress={commands.toggleOperating}
        />
        <StopRun commands={commands} />
      </Group>
      {control && (
        <Text size="sm" {...(control.operator === 'lost' ? { c: 'var(--stopped)', fw: 650 } : { c: 'var(--quiet)' })}>
          {operatorWords(control, isMine)}
        </Text>
      )}
    </Stack>
  )
}

export function StopRun({ commands }: { commands: Commands }) {
  return (
    <CommandButton
      label="Stop"
      hint="The robots decelerate to rest and the run ends"
      icon={<IconPlayerStopFilled size={15} aria-hidden />}
      tone="danger"
      obstacle={commands.obstacle('stop')}
      onObstacle={() => commands.explain('stop', 'Stop')}
      onPress={commands.stop}
    />
  )
}

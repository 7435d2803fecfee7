/** Says on every page that the cell is stopped, for as long as no run may start, and leads to the recovery guide. */
import { Box, Button, Group, Text } from '@mantine/core'
import { IconHandStop, IconListCheck } from '@tabler/icons-react'
import { useEffect } from 'react'
import { loadStop, pollStop, recovery } from '../../api/recovery'
import { useLive } from '../../api/live'
import { useStop } from '../../api/stopStore'
import type { CellStop } from '../../api/types'
import { deviceWords, nextStep, stepsOf } from '../../document/recovery'
import { wallTime } from '../../document/time'
import { openGuide, useGuide } from './guide'

const TITLES: Readonly<Record<CellStop['phase'], string>> = {
  stopping: 'The cell is stopping',
  stopped: 'Cell stopped',
  released: 'The stop is released',
}

export function StoppedBanner() {
  const stop = useLive((s) => s.stop)
  const isLive = useLive((s) => s.connection === 'live')
  const isOpen = useGuide((s) => s.isOpen)
  const isOurs = useStop((s) => s.stop !== undefined)
  useEffect(() => {
    // Whoever has pressed STOP is led on; the others see the banner.
    if (isOurs) openGuide(true)
  }, [isOurs])
  useEffect(() => {
    if (isLive) return
    void loadStop().catch(() => undefined)
    return pollStop()
  }, [isLive])
  if (!stop) return null
  const next = stepsOf(stop).find((step) => step.id === nextStep(stepsOf(stop)))
  return (
    <Group
      component="section"
      gap="sm"
      px="md"
      py="xs"
      bg={stop.phase === 'released' ? 'var(--done-soft)' : 'var(--failed-soft)'}
      style={{ border: `0 solid var(--${stop.phase === 'released' ? 'done' : 'failed'})`, borderWidth: '0 0 1px 10px' }}
      aria-label="Stopped cell"
    >
      <IconHandStop size={22} style={{ flex: 'none' }} aria-hidden />
      <Box flex="1 1 18rem" miw={0} style={{ overflowWrap: 'anywhere' }}>
        <Text size="sm" role="status">
          <Text span size="md" fw={700}>
            {TITLES[stop.phase]}
          </Text>{' '}
          {stop.phase === 'released'
            ? 'Runs can start.'
            : `since ${wallTime(stop.since_unix_s)}: ${stop.reason}. No run starts until the stop is released.`}
        </Text>
        <Text size="xs">{stop.devices.map((device) => `${device.name} ${deviceWords(device)}`).join(' · ')}</Text>
        {next && (
          <Text size="xs">
            Next: {next.title} ({next.words})
          </Text>
        )}
      </Box>
      <Group gap="xs">
        <Button
          size="sm"
          variant="default"
          leftSection={<IconListCheck size={16} aria-hidden />}
          aria-expanded={isOpen}
          onClick={() => openGuide(!isOpen)}
        >
          {isOpen ? 'Close the guide' : 'Recovery guide'}
        </Button>
        {stop.phase === 'released' && <EndRecovery />}
      </Group>
    </Group>
  )
}

function EndRecovery() {
  const mayOperate = useLive((s) => s.role === 'operator')
  if (!mayOperate) return null
  return (
    <Button size="sm" variant="subtle" onClick={() => void recovery.close().catch(() => undefined)}>
      Finish
    </Button>
  )
}

/** Says on every page that the cell is stopped, for as long as no run may start, and leads to the recovery guide. */
import { Button } from '@mantine/core'
import { IconHandStop, IconListCheck } from '@tabler/icons-react'
import { useEffect } from 'react'
import { loadStop, pollStop, recovery } from '../../api/recovery'
import { useLive } from '../../api/live'
import { useStop } from '../../api/stopStore'
import type { CellStop } from '../../api/types'
import { deviceWords, nextStep, stepsOf } from '../../document/recovery'
import { wallTime } from '../../document/time'
import { openGuide, useGuide } from './guide'
import classes from './recovery.module.css'

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
    <section className={classes['banner']} data-phase={stop.phase} aria-label="Stopped cell">
      <IconHandStop size={22} aria-hidden />
      <div className={classes['bannerWords']}>
        <p role="status">
          <strong>{TITLES[stop.phase]}</strong>{' '}
          {stop.phase === 'released'
            ? 'Runs can start.'
            : `since ${wallTime(stop.since_unix_s)}: ${stop.reason}. No run starts until the stop is released.`}
        </p>
        <p className={classes['devices']}>{stop.devices.map((device) => `${device.name} ${deviceWords(device)}`).join(' · ')}</p>
        {next && (
          <p className={classes['devices']}>
            Next: {next.title} ({next.words})
          </p>
        )}
      </div>
      <div className={classes['bannerTools']}>
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
      </div>
    </section>
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

/** How far a sweep is, and starting, stopping and continuing it. */
import { Button, Progress, Text } from '@mantine/core'
import { IconPlayerPlay, IconPlayerStop } from '@tabler/icons-react'
import { useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { wordsOf } from '../../api/client'
import { sweepsApi } from '../../api/sweeps'
import type { SweepLive } from '../../api/types'
import { intervalText, percent, rateOf, speedText } from '../../document/sweeps'
import { Note } from './Note'
import { BigFigure } from './BigFigure'

export interface SweepControlsProps {
  readonly sweep: string
  readonly live: SweepLive
  readonly mayOperate: boolean
  /** The configurations whose process crashed or hung. */
  readonly broken: number
}

export function SweepControls({ sweep, live, mayOperate, broken }: SweepControlsProps) {
  const [isStarting, setStarting] = useState(false)
  const [problem, setProblem] = useState('')
  const left = live.planned - live.done

  async function start(again: boolean): Promise<void> {
    setStarting(true)
    setProblem('')
    try {
      await sweepsApi.start(sweep, again)
    } catch (error) {
      setProblem(wordsOf(error))
    }
    setStarting(false)
  }

  const over = overText(live)
  const isOver = over !== ''
  return (
    <>
      {mayOperate && live.status === 'idle' && left > 0 && (
        <Button
          size="xs"
          aria-disabled={isStarting || isOver || undefined}
          data-disabled={isStarting || isOver}
          title={isOver ? `${over}: no run would be executed` : undefined}
          leftSection={<IconPlayerPlay size={15} aria-hidden />}
          onClick={() => !isStarting && !isOver && void start(false)}
        >
          {isStarting ? 'Starting …' : live.done === 0 ? `Start ${left} runs` : `Go on with ${left} runs`}
        </Button>
      )}
      {mayOperate && live.status === 'idle' && broken > 0 && (
        <Button
          size="xs"
          variant="default"
          aria-disabled={isStarting || undefined}
          data-disabled={isStarting}
          onClick={() => !isStarting && void start(true)}
        >
          Try {broken} crashed {broken === 1 ? 'run' : 'runs'} again
        </Button>
      )}
      {mayOperate && live.status !== 'idle' && (
        <Button
          size="xs"
          variant="default"
          c="var(--failed)"
          aria-disabled={live.status === 'stopping' || undefined}
          data-disabled={live.status === 'stopping'}
          onClick={() => {
            if (live.status === 'running') void sweepsApi.stop(sweep).catch((error: unknown) => setProblem(wordsOf(error)))
          }}
          leftSection={<IconPlayerStop size={15} aria-hidden />}
        >
          {live.status === 'stopping' ? 'Stopping …' : 'Stop the sweep'}
        </Button>
      )}
      <Refusal>{problem || live.problem}</Refusal>
    </>
  )
}

/** Why no more runs are needed; empty where they are. */
function overText({ verdict, search }: SweepLive): string {
  if (search?.is_satisfied) return 'as many failures are found as it is for'
  return verdict === 'passed' || verdict === 'failed' ? 'what is required is decided' : ''
}

/** How much of what is planned is done, in percent. */
export function shareDone({ done, planned }: SweepLive): number {
  return (100 * done) / Math.max(planned, 1)
}

/** The bar with the runs that are done, and what they say until now. */
export function SweepProgress({ live }: { readonly live: SweepLive }) {
  const speed = speedText(live)
  const over = live.status === 'idle' && live.done < live.planned ? overText(live) : ''
  return (
    <div>
      <Progress size="sm" value={shareDone(live)} aria-label={`${live.done} of ${live.planned} runs are done`} />
      <Note role={live.status === 'idle' ? undefined : 'status'}>
        {live.done} of {live.planned} runs
        {live.status !== 'idle' && speed && (
          <Text span inherit c="dimmed">
            {' '}
            · {speed}
          </Text>
        )}
        {over && (
          <Text span inherit c="dimmed">
            {' '}
            · {over}: no more are needed
          </Text>
        )}
        {live.status === 'running' && !speed && (
          <Text span inherit c="dimmed">
            {' '}
            · loading what the runs need
          </Text>
        )}
      </Note>
    </div>
  )
}

/** The success rate in large digits, with its interval. */
export function SuccessRate({ live }: { readonly live: SweepLive }) {
  const rate = rateOf(live)
  return (
    <BigFigure figure={rate === undefined ? '–' : percent(rate)}>
      <span>
        {rate === undefined ? 'No run has ended yet' : `${live.successes} of ${live.looked_at} succeeded`}
        {live.interval && rate !== undefined && (
          <Text span inherit c="dimmed">
            {' '}
            · the rate is {intervalText(live.interval)}
          </Text>
        )}
      </span>
    </BigFigure>
  )
}

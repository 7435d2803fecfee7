/** How far a sweep is, and starting, stopping and continuing it. */
import { IconPlayerPlay, IconPlayerStop } from '@tabler/icons-react'
import { useState } from 'react'
import { wordsOf } from '../../api/client'
import { sweepsApi } from '../../api/sweeps'
import type { SweepLive } from '../../api/types'
import { intervalText, percent, rateOf, speedText } from '../../document/sweeps'

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
        <button
          type="button"
          className="command is-strong"
          aria-disabled={isStarting || isOver || undefined}
          title={isOver ? `${over}: no run would be executed` : undefined}
          onClick={() => !isStarting && !isOver && void start(false)}
        >
          <IconPlayerPlay size={15} aria-hidden />
          {isStarting ? 'Starting …' : live.done === 0 ? `Start ${left} runs` : `Go on with ${left} runs`}
        </button>
      )}
      {mayOperate && live.status === 'idle' && broken > 0 && (
        <button type="button" className="command" aria-disabled={isStarting || undefined} onClick={() => !isStarting && void start(true)}>
          Try {broken} crashed {broken === 1 ? 'run' : 'runs'} again
        </button>
      )}
      {mayOperate && live.status !== 'idle' && (
        <button
          type="button"
          className="command is-danger"
          aria-disabled={live.status === 'stopping' || undefined}
          onClick={() => {
            if (live.status === 'running') void sweepsApi.stop(sweep).catch((error: unknown) => setProblem(wordsOf(error)))
          }}
        >
          <IconPlayerStop size={15} aria-hidden />
          {live.status === 'stopping' ? 'Stopping …' : 'Stop the sweep'}
        </button>
      )}
      {(problem || live.problem) && (
        <p className="is-failed sweep-problem" role="alert">
          {problem || live.problem}
        </p>
      )}
    </>
  )
}

/** Why no more runs are needed; empty where they are. */
function overText({ verdict, search }: SweepLive): string {
  if (search?.is_satisfied) return 'as many failures are found as it is for'
  return verdict === 'passed' || verdict === 'failed' ? 'what is required is decided' : ''
}

/** The bar with the runs that are done, and what they say until now. */
export function SweepProgress({ live }: { readonly live: SweepLive }) {
  const speed = speedText(live)
  const over = live.status === 'idle' && live.done < live.planned ? overText(live) : ''
  return (
    <div className="sweep-progress">
      <progress max={Math.max(live.planned, 1)} value={live.done} aria-label={`${live.done} of ${live.planned} runs are done`} />
      <p className="sweep-note" role={live.status === 'idle' ? undefined : 'status'}>
        {live.done} of {live.planned} runs
        {live.status !== 'idle' && speed && <span className="quiet"> · {speed}</span>}
        {over && <span className="quiet"> · {over}: no more are needed</span>}
        {live.status === 'running' && !speed && <span className="quiet"> · loading what the runs need</span>}
      </p>
    </div>
  )
}

/** The success rate in large digits, with its interval. */
export function SuccessRate({ live }: { readonly live: SweepLive }) {
  const rate = rateOf(live)
  return (
    <p className="sweep-success">
      <strong>{rate === undefined ? '–' : percent(rate)}</strong>
      <span>
        {rate === undefined ? 'No run has ended yet' : `${live.successes} of ${live.looked_at} succeeded`}
        {live.interval && rate !== undefined && <span className="quiet"> · the rate is {intervalText(live.interval)}</span>}
      </span>
    </p>
  )
}

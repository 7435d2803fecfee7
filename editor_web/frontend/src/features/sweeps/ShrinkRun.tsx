/** Shrinks a failing run to the smallest change from nominal that still fails, and saves that as a test case. */
import { IconArrowsMinimize, IconPlayerStop } from '@tabler/icons-react'
import { useState } from 'react'
import { sweepsApi } from '../../api/sweeps'
import type { ShrinkBody, Shrinking, TrialResult } from '../../api/types'
import { foundOf } from '../../document/searches'
import { ShrunkChange } from './ShrunkChange'
import { useShrinking } from './useShrinking'

export interface ShrinkRunProps {
  readonly sweep: string
  readonly run: TrialResult
  readonly subject: string
  readonly mayOperate: boolean
  readonly onOpenSweep: (id: string) => void
}

type Same = NonNullable<ShrinkBody['same']>

export function ShrinkRun({ sweep, run, subject, mayOperate, onOpenSweep }: ShrinkRunProps) {
  const { number } = run.configuration
  const { shrinking, problem, request } = useShrinking(sweep, number)
  const [same, setSame] = useState<Same>('outcome')
  const found = foundOf(shrinking, subject, run.configuration)
  const isRunning = shrinking !== undefined && shrinking.status !== 'idle'
  const words = problem || shrinking?.problem
  if (!mayOperate && !found && !isRunning) return null
  return (
    <section className="sweep-shrink" aria-label="The smallest change that fails">
      <h3 className="sweep-subtitle">The smallest change that fails</h3>
      {isRunning && (
        <Progress shrinking={shrinking} mayOperate={mayOperate} onStop={() => void request(() => sweepsApi.stopShrinking(sweep, number))} />
      )}
      {!isRunning && found && shrinking && (
        <ShrunkChange
          sweep={sweep}
          number={number}
          found={found.shrunk}
          savedAs={shrinking.saved_as}
          onSave={mayOperate ? (file) => request(() => sweepsApi.saveCase(sweep, number, file)) : undefined}
          onOpenSweep={onOpenSweep}
        />
      )}
      {!isRunning && mayOperate && (
        <>
          <div className="sweep-shrink-start">
            <button type="button" className="command" onClick={() => void request(() => sweepsApi.shrink(sweep, number, { same }))}>
              <IconArrowsMinimize size={15} aria-hidden />
              {found ? 'Shrink it again' : 'Shrink this run'}
            </button>
            <label>
              as long as{' '}
              <select className="new-input" value={same} onChange={(event) => setSame(event.currentTarget.value as Same)}>
                <option value="outcome">it ends the same way</option>
                <option value="cause">its root cause is the same too</option>
              </select>
            </label>
          </div>
          {!found && (
            <p className="quiet sweep-note">
              Takes chance out, sets factors back to nominal, and moves the others towards it. That takes some tens of runs, in a process
              with a low priority.
            </p>
          )}
        </>
      )}
      {words && (
        <p className="is-failed" role="alert">
          {words}
        </p>
      )}
    </section>
  )
}

function Progress({
  shrinking: { status, progress },
  mayOperate,
  onStop,
}: {
  readonly shrinking: Shrinking
  readonly mayOperate: boolean
  readonly onStop: () => void
}) {
  const isStopping = status === 'stopping'
  const runs = progress?.runs ?? 0
  return (
    <>
      <div className="sweep-shrink-start">
        <progress max={progress?.most_runs ?? 1} value={runs} aria-label={`${runs} runs tried`} />
        {mayOperate && (
          <button
            type="button"
            className="command is-danger"
            aria-disabled={isStopping || undefined}
            onClick={() => !isStopping && onStop()}
          >
            <IconPlayerStop size={15} aria-hidden />
            {isStopping ? 'Stopping …' : 'Stop with the smallest so far'}
          </button>
        )}
      </div>
      <p className="sweep-note" role="status">
        {progress ? `${progress.runs} of at most ${progress.most_runs} runs tried: ${progress.step}` : 'Loading what the runs need'}
      </p>
      {progress && (
        <p className="quiet sweep-note">
          Still varied: <span className="mono">{progress.changed.join(', ') || 'nothing'}</span>
        </p>
      )}
    </>
  )
}

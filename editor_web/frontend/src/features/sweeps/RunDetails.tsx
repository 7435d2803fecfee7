/** One run of a sweep: how it ended, with which values, where its time went; and the run itself, executed again. */
import { IconPlayerPlay, IconX } from '@tabler/icons-react'
import { useEffect, useRef, useState } from 'react'
import { wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { recordRun, sweepQueries } from '../../api/sweeps'
import type { RecordedTrial, TrialResult } from '../../api/types'
import { RunBadge } from '../../components/StatusBadge'
import { labelOf, short } from '../../document/sweeps'
import { duration } from '../../document/time'
import { ShrinkRun } from './ShrinkRun'

const NODES = 8

export interface RunDetailsProps {
  readonly sweep: string
  readonly number: number
  /** The hash of the versions that were executed. */
  readonly subject: string
  readonly mayOperate: boolean
  readonly onOpen: (recording: string) => void
  readonly onOpenSweep: (id: string) => void
  readonly onClose: () => void
}

export function RunDetails({ sweep, number, subject, mayOperate, onOpen, onOpenSweep, onClose }: RunDetailsProps) {
  const { value: run, problem } = useAnswer(sweepQueries.run(sweep, number))
  const element = useRef<HTMLElement>(null)
  useEffect(() => {
    // A run may be chosen far from where it is told of. What this returns is no clean-up.
    element.current?.scrollIntoView({ block: 'nearest' })
  }, [run])
  return (
    <section ref={element} className="sweep-card sweep-details" aria-label={`Run ${number}`}>
      <header className="sweep-card-head">
        <h2>Run {number}</h2>
        {run && <RunBadge run={run} />}
        <span className="spacer" />
        <button type="button" className="command is-quiet" aria-label={`Close run ${number}`} onClick={onClose}>
          <IconX size={15} aria-hidden />
        </button>
      </header>
      {problem && (
        <p className="is-failed" role="alert">
          {problem}
        </p>
      )}
      {run && (
        <>
          {run.cause && <p className="sweep-chain">{run.cause}</p>}
          {mayOperate && <Again sweep={sweep} run={run} onOpen={onOpen} />}
          {!run.success && <ShrinkRun sweep={sweep} run={run} subject={subject} mayOperate={mayOperate} onOpenSweep={onOpenSweep} />}
          <Facts run={run} />
          <p className="quiet sweep-note">
            In a terminal:{' '}
            <code className="sweep-command">
              flexcell sweep rerun {sweep} {number}
            </code>
            {!run.success && (
              <>
                {' '}
                and{' '}
                <code className="sweep-command">
                  flexcell sweep shrink {sweep} {number}
                </code>
              </>
            )}
          </p>
        </>
      )}
    </section>
  )
}

function Facts({ run }: { readonly run: TrialResult }) {
  const times = Object.entries(run.nodes)
    .map(([path, time]) => [path, time?.total_s ?? 0] as const)
    .toSorted((left, right) => right[1] - left[1])
  return (
    <dl className="sweep-facts">
      <Fact name="duration" value={duration(run.duration_s)} />
      <Fact name="seed" value={String(run.configuration.seed)} />
      {Object.entries(run.configuration.values).map(([address, value]) => (
        <Fact key={address} name={address} value={short(value)} />
      ))}
      {times.slice(0, NODES).map(([path, seconds]) => (
        <Fact key={path} name={path} value={duration(seconds)} />
      ))}
      {Object.entries(run.measures).map(([key, value]) => (
        <Fact key={`measure ${key}`} name={key} value={short(value)} />
      ))}
      {Object.entries(run.outputs).map(([key, value]) => (
        <Fact key={`output ${key}`} name={`output ${key}`} value={short(value)} />
      ))}
    </dl>
  )
}

function Fact({ name, value }: { readonly name: string; readonly value: string }) {
  return (
    <>
      <dt className="mono">{name}</dt>
      <dd>{value}</dd>
    </>
  )
}

/** Executes the run again with recording; the recording opens by itself where the run was the same. */
function Again({
  sweep,
  run,
  onOpen,
}: {
  readonly sweep: string
  readonly run: TrialResult
  readonly onOpen: (recording: string) => void
}) {
  const [isAsking, setAsking] = useState(false)
  const [recorded, setRecorded] = useState<RecordedTrial>()
  const [problem, setProblem] = useState('')

  async function again(): Promise<void> {
    setAsking(true)
    setProblem('')
    try {
      const made = await recordRun(sweep, run.configuration.number)
      setRecorded(made)
      if (made.same && made.recording) onOpen(made.recording)
    } catch (error) {
      setProblem(wordsOf(error))
    }
    setAsking(false)
  }

  return (
    <div className="sweep-again">
      <button type="button" className="command is-strong" aria-disabled={isAsking || undefined} onClick={() => !isAsking && void again()}>
        <IconPlayerPlay size={15} aria-hidden />
        {isAsking ? 'Executing it again …' : 'Open with graph, timeline and 3D'}
      </button>
      <p className="quiet sweep-note" role="status">
        {isAsking
          ? 'The run is executed again and recorded; it opens when it has ended.'
          : 'Executes this configuration again, and records it.'}
      </p>
      {recorded && !recorded.same && (
        <p className="is-failed" role="alert">
          It ended differently this time: {labelOf(recorded.result)} with {recorded.result.events} events, before {labelOf(recorded.saved)}{' '}
          with {recorded.saved.events}.
          {recorded.recording && (
            <>
              {' '}
              <button type="button" className="link" onClick={() => onOpen(recorded.recording)}>
                Open it anyway
              </button>
            </>
          )}
        </p>
      )}
      {problem && (
        <p className="is-failed" role="alert">
          {problem}
        </p>
      )}
    </div>
  )
}

/** How a run failed: what to do, the way down to the node where it began, the causes, and what happened there. */
import './styles/timeline.css'
import { IconCircleCheck, IconCircleX, IconHistory } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
import { pastApi, seekEvent, type Subject } from '../../api/timeline'
import type { RunFailure, RunView } from '../../api/types'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { isActive } from '../../document/runState'
import { useSubject } from './useSubject'

export interface FailureViewProps {
  readonly run: RunView | undefined
  readonly onShow: (path: string) => void
}

export function FailureView({ run, onShow }: FailureViewProps) {
  const subject = useSubject(run)
  const isOver = run !== undefined && !isActive(run)
  const { failure, problem } = useFailure(subject, isOver)

  function show(at: At): void {
    if (subject) seekEvent(subject, at)
    if (at.path) onShow(at.path)
  }

  return (
    <Panel title="Failure" tools={failure && subject && <Tools failure={failure} onShow={show} />}>
      {failure && subject ? (
        <FailureText failure={failure} onShow={show} />
      ) : (
        <Empty icon={<IconCircleCheck size={26} stroke={1.4} aria-hidden />} title={problem || emptyTitle(run, isOver, failure)}>
          When a run fails, this tab tells where it began, why, and what to do.
        </Empty>
      )}
    </Panel>
  )
}

interface At {
  readonly seq: number
  readonly time_s: number
  readonly path: string
}

function Tools({ failure, onShow }: { failure: RunFailure; onShow: (at: At) => void }) {
  return (
    <>
      <span className="failure-place quiet">
        {failure.path ? `It began in ${failure.path}` : 'It began in the run itself'} at {failure.time_s.toFixed(2)} s
      </span>
      <span className="spacer" />
      <button type="button" className="command is-strong" onClick={() => onShow(failure)}>
        <IconHistory size={15} aria-hidden />
        <span className="command-label">Show the moment</span>
      </button>
    </>
  )
}

function emptyTitle(run: RunView | undefined, isOver: boolean, failure: RunFailure | null | undefined): string {
  if (!run) return 'No run yet'
  if (!isOver) return 'The run is active'
  return failure === undefined ? 'Reading…' : 'This run did not fail'
}

interface Found {
  /** Undefined until the server has answered. */
  readonly failure: RunFailure | null | undefined
  readonly problem: string
}

function useFailure(subject: Subject | undefined, isOver: boolean): Found {
  const [found, setFound] = useState<Found>({ failure: undefined, problem: '' })
  useEffect(() => {
    setFound({ failure: undefined, problem: '' })
    if (!subject || !isOver) return
    let isCurrent = true
    pastApi.failure(subject).then(
      (failure) => isCurrent && setFound({ failure, problem: '' }),
      (error: unknown) => isCurrent && setFound({ failure: null, problem: wordsOf(error) }),
    )
    return () => {
      isCurrent = false
    }
  }, [subject, isOver])
  return found
}

function FailureText({ failure, onShow: show }: { failure: RunFailure; onShow: (at: At) => void }) {
  const { links, steps, around, hint, path } = failure
  return (
    <div className="failure" tabIndex={0} role="region" aria-label="How the run failed">
      <div className="failure-head">
        <IconCircleX size={19} aria-hidden />
        <h3>{failure.text}</h3>
      </div>
      {hint && (
        <p className="failure-hint">
          <strong>What to do: </strong>
          {hint}
        </p>
      )}
      <div className="failure-parts">
        {steps.length > 0 && (
          <section>
            <h4>Where</h4>
            <ol className="failure-steps">
              {steps.map((step, index) => (
                <li key={step.path} className={step.path === path ? 'is-origin' : undefined} style={{ marginInlineStart: Math.max(0, index - 1) * 14 }}>
                  <button type="button" className="link-row" onClick={() => show(step)}>
                    {step.path.split('/').pop()}
                  </button>{' '}
                  <span className="quiet">
                    {step.text} at {step.time_s.toFixed(2)} s
                  </span>
                </li>
              ))}
            </ol>
          </section>
        )}
        {links.length > 0 && (
          <section>
            <h4>Why</h4>
            <ol>
              {links.map((link, index) => (
                <li key={index} className={index === 0 ? 'is-origin' : undefined}>
                  {index > 0 && <span className="quiet">so </span>}
                  {link.message}
                  <div className="quiet mono">{[link.kind, link.where].filter(Boolean).join(' · ')}</div>
                </li>
              ))}
            </ol>
          </section>
        )}
        {around.length > 0 && (
          <section>
            <h4>What happened there</h4>
            <ol>
              {around.map((line) => (
                <li key={line.seq}>
                  <button type="button" className="link-row" onClick={() => show(line)}>
                    {line.time_s.toFixed(2)} s
                  </button>{' '}
                  {line.text}
                </li>
              ))}
            </ol>
          </section>
        )}
      </div>
    </div>
  )
}

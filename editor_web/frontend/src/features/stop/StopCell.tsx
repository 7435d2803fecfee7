/** STOP of the cell, over every page and dialog, and what became of it; it needs nothing of the rest of the page. */
import { IconHandStop, IconX } from '@tabler/icons-react'
import { useEffect, useRef } from 'react'
import { createPortal } from 'react-dom'
import { api } from '../../api/client'
import { useSession } from '../../api/session'
import { forgetStop, stopCell } from '../../api/stopCell'
import { useStop } from '../../api/stopStore'
import { useTop } from '../../components/modal'
import { letTabReach } from '../../components/stopFocus'
import { listenForStopKey, STOP_KEY } from '../../components/stopKey'
import { reportOf } from '../../document/stopReport'
import classes from './stop.module.css'

const HINT =
  'Stops every run and every goal; the arms decelerate to rest, also when the engine does not answer. ' +
  'This is no emergency stop: press the button at the cell where people are in danger. ' +
  `Key: ${STOP_KEY}`
/** So long stands what needs no attention. */
const SHOWN_MS = 8000

export function StopCell() {
  const role = useSession((s) => s.session?.role)
  const isShown = role === 'operator'
  const top = useTop()
  // The page asks too; STOP does not depend on it.
  useEffect(() => void api.session().catch(() => undefined), [])
  const button = useRef<HTMLButtonElement>(null)
  useEffect(() => listenForStopKey(), [])
  useEffect(() => letTabReach(() => button.current), [])
  useEffect(() => {
    // The page comes with room for it, so that nothing moves when it is there.
    if (role !== undefined) document.body.toggleAttribute('data-has-stop', isShown)
  }, [role, isShown])
  if (!isShown) return null
  return createPortal(
    <section className={classes.stop} aria-label="Stop of the cell">
      {/* No button of the kit: it works also where the page and the kit have failed. */}
      <button
        ref={button}
        type="button"
        className={classes.button}
        title={HINT}
        aria-keyshortcuts="Control+Shift+Backspace"
        onClick={stopCell}
      >
        <IconHandStop size={24} aria-hidden />
        <span>
          Stop<span className={classes.rest}> the cell</span>
        </span>
      </button>
      <StopMessage />
    </section>,
    top,
  )
}

/** The area is there before anything is said in it, or it would not be read out. */
function StopMessage() {
  const stop = useStop((s) => s.stop)
  const report = stop && reportOf(stop)
  const isDone = report?.level === 'done'
  useEffect(() => {
    if (!isDone) return
    const timer = setTimeout(forgetStop, SHOWN_MS)
    return () => clearTimeout(timer)
  }, [isDone, stop?.number])
  return (
    <div role="status" aria-live="assertive" aria-label="State of the stop">
      {report && (
        <div className={classes.report} data-level={report.level} role={report.level === 'alarm' ? 'alert' : undefined}>
          <strong>{report.title}</strong>
          {report.lines.map((line) => (
            <p key={line}>{line}</p>
          ))}
          <button type="button" className={classes.away} aria-label="Put the words about the stop away" onClick={forgetStop}>
            <IconX size={16} aria-hidden />
          </button>
        </div>
      )}
    </div>
  )
}

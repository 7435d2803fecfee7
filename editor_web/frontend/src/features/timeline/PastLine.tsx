/** Says that the past is shown, which moment of it, and leads back. */
import './styles/timeline.css'
import { IconHistory } from '@tabler/icons-react'
import { useEffect } from 'react'
import { backToPresent, leave, servesCell, useTimeline } from '../../api/timeline'
import { useLive } from '../../api/live'
import type { RunView } from '../../api/types'
import { useSubject } from './useSubject'

export interface PastLineProps {
  readonly run: RunView | undefined
  readonly hasCellView: boolean
}

export function PastLine({ run, hasCellView }: PastLineProps) {
  const subject = useSubject(run)
  const timeS = useTimeline((s) => s.timeS)
  const problem = useTimeline((s) => s.problem)
  const isActive = useLive((s) => s.control !== null)
  useEffect(() => servesCell(hasCellView), [hasCellView])
  useEffect(() => (subject && !subject.isPast ? () => leave(subject) : undefined), [subject])
  if (!subject || timeS === undefined) return null
  return (
    <div className="past-place">
      <div className="past-line">
        <IconHistory size={17} aria-hidden />
        <span>
          {/* Told once, not with every step of the cursor. */}
          <span className="visually-hidden" role="status">
            You see the past
          </span>
          <span aria-hidden>
            You see <strong>{timeS.toFixed(2)} s</strong> of the past{isActive && '; the bar above commands the run as it is now'}
          </span>
          {problem && <span role="alert"> {problem}</span>}
        </span>
        <button type="button" className="command is-strong" onClick={() => backToPresent(subject)}>
          <span className="command-label">{subject.isPast ? 'To the end' : 'Back to live'}</span>
        </button>
      </div>
    </div>
  )
}

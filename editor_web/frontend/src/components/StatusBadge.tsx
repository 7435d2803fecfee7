/** A run's status as a small label. */
import { StatusIcon, statusOf } from './StatusIcon'

export interface StatusBadgeProps {
  readonly status: string
  readonly outcome?: string | null
  /** Whether a finished run ended well. */
  readonly success?: boolean
}

export function StatusBadge({ status, outcome, success = true }: StatusBadgeProps) {
  const shown = status === 'finished' && !success ? 'failed' : statusOf(status)
  return (
    <span className={`badge is-${shown}`}>
      <StatusIcon status={shown} size={13} />
      {outcome && outcome !== status ? `${status}: ${outcome}` : status}
    </span>
  )
}

/** A status as icon and colour: the shape alone tells it, for those who do not see the colour. */
import {
  IconAlertTriangleFilled,
  IconCircleCheckFilled,
  IconCircleDashed,
  IconCircleXFilled,
  IconPlayerPlayFilled,
  IconPlayerStopFilled,
  IconPlayerTrackNextFilled,
} from '@tabler/icons-react'

export type Status = 'idle' | 'active' | 'done' | 'failed' | 'stopped' | 'skipped' | 'warning'

/** Statuses of nodes and of runs, and the severities of findings, in one vocabulary. */
export function statusOf(word: string): Status {
  switch (word) {
    case 'active':
    case 'running':
      return 'active'
    case 'done':
    case 'finished':
      return 'done'
    case 'failed':
    case 'errored':
    case 'error':
      return 'failed'
    case 'stopped':
    case 'stopping':
      return 'stopped'
    case 'skipped':
      return 'skipped'
    case 'warning':
      return 'warning'
    default:
      return 'idle'
  }
}

const ICONS = {
  idle: IconCircleDashed,
  active: IconPlayerPlayFilled,
  done: IconCircleCheckFilled,
  failed: IconCircleXFilled,
  stopped: IconPlayerStopFilled,
  skipped: IconPlayerTrackNextFilled,
  warning: IconAlertTriangleFilled,
}

export function StatusIcon({ status, size = 16 }: { status: Status; size?: number }) {
  const Icon = ICONS[status]
  return <Icon size={size} className={`status-icon is-${status}`} aria-hidden />
}

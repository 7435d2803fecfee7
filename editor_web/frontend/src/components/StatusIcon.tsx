/** A status as icon and colour: the shape alone tells it, for those who do not see the colour. */
import {
  IconAlertTriangleFilled,
  IconCircleCheckFilled,
  IconCircleDashed,
  IconCircleXFilled,
  IconHelpCircleFilled,
  IconLockFilled,
  IconPlayerPauseFilled,
  IconPlayerPlayFilled,
  IconPlayerStopFilled,
  IconPlayerTrackNextFilled,
} from '@tabler/icons-react'
import type { Status } from '../document/runState'

const ICONS = {
  idle: IconCircleDashed,
  active: IconPlayerPlayFilled,
  done: IconCircleCheckFilled,
  failed: IconCircleXFilled,
  stopped: IconPlayerStopFilled,
  skipped: IconPlayerTrackNextFilled,
  warning: IconAlertTriangleFilled,
  paused: IconPlayerPauseFilled,
  waiting: IconHelpCircleFilled,
  locked: IconLockFilled,
}

export function StatusIcon({ status, size = 16 }: { status: Status; size?: number }) {
  const Icon = ICONS[status]
  return <Icon size={size} data-status={status} style={{ flex: 'none', color: 'var(--status)' }} aria-hidden />
}

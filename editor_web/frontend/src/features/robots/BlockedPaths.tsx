/** Which arms wait because their path is blocked: by what, and for how long. */
import { IconBarrierBlock } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { serverNow, useLive } from '../../api/live'
import { Notice } from '../../components/Notice'
import { blockedPaths, sinceWords } from '../../document/plannedPaths'

export function BlockedPaths() {
  const robots = useLive((s) => s.robots)
  const blocked = blockedPaths(robots)
  return (
    <div aria-live="polite">
      {blocked.length > 0 && (
        <ul className="plain-list" aria-label="Arms with a blocked path">
          {blocked.map(({ robot, path }) => (
            <li key={robot}>
              <Notice icon={<IconBarrierBlock size={18} aria-hidden />}>
                <strong>{robot}</strong> waits: {path.reason || 'its path is blocked'}, since <Since sinceS={path.since_s} />
              </Notice>
            </li>
          ))}
        </ul>
      )}
    </div>
  )
}

function Since({ sinceS }: { sinceS: number }) {
  const [now, setNow] = useState(serverNow)
  useEffect(() => {
    const timer = setInterval(() => setNow(serverNow()), 500)
    return () => clearInterval(timer)
  }, [])
  // The time is not announced again and again.
  return (
    <span role="timer" aria-live="off" style={{ fontVariantNumeric: 'tabular-nums' }}>
      {sinceWords(now - sinceS)}
    </span>
  )
}

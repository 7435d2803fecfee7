/** Which arms wait because their path is blocked: by what, and for how long. */
import { Text } from '@mantine/core'
import { IconBarrierBlock } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { serverNow, useLive } from '../../api/live'
import { Notice } from '../../components/Notice'
import { blockedPaths, sinceWords, type BlockedPath } from '../../document/plannedPaths'

interface BlockedPathsProps {
  /** All in one line, which is cut where there is no room and whole in its title. */
  readonly isLine?: boolean
}

export function BlockedPaths({ isLine = false }: BlockedPathsProps) {
  const blocked = blockedPaths(useLive((s) => s.robots))
  const title = isLine ? blocked.map(({ robot, path }) => `${robot} waits: ${path.reason}`).join('\n') : undefined
  return (
    <div aria-live="polite">
      {blocked.length > 0 && (
        <Text
          component="ul"
          className="plain-list"
          inherit
          truncate={isLine}
          title={title}
          {...(isLine && { c: 'var(--failed)' })}
          aria-label="Arms with a blocked path"
        >
          {blocked.map(({ robot, path }, at) => (
            <li key={robot} style={isLine ? { display: 'inline' } : undefined}>
              {isLine ? (
                <>
                  {at > 0 && ' · '}
                  <IconBarrierBlock size={15} aria-hidden style={{ verticalAlign: '-2px' }} /> <Blocked robot={robot} path={path} />
                </>
              ) : (
                <Notice icon={<IconBarrierBlock size={18} aria-hidden />}>
                  <Blocked robot={robot} path={path} />
                </Notice>
              )}
            </li>
          ))}
        </Text>
      )}
    </div>
  )
}

function Blocked({ robot, path }: BlockedPath) {
  return (
    <>
      <strong>{robot}</strong> waits: {path.reason || 'its path is blocked'}, since <Since sinceS={path.since_s} />
    </>
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

/** Lets the server prepare an arm as long as its jog panel is shown, so that the first press moves it. */
import { useEffect } from 'react'
import { sendToServer, useDisabledReason, useTeach } from '../../api/teaching'
import { lookup } from '../../document/dict'

interface PreparedJog {
  /** Why nothing can be pressed yet; undefined once it can. */
  readonly obstacle: string | undefined
  /** Why the arm could not be prepared; empty where it could. */
  readonly fault: string
}

export function usePreparedJog(arm: string): PreparedJog {
  const isOff = useDisabledReason() !== undefined
  const readiness = useTeach((s) => lookup(s.readiness, arm))
  useEffect(() => {
    if (isOff) return
    sendToServer({ k: 'prepare', arm })
    return () => sendToServer({ k: 'prepare', arm: '' })
  }, [arm, isOff])
  // A press tries again what could not be prepared, and tells why it fails.
  const isPrepared = readiness !== undefined && (readiness.ready || readiness.reason !== '')
  return { obstacle: isPrepared ? undefined : 'Preparing: the collision checks of this arm are loading', fault: readiness?.reason ?? '' }
}

/** Time on the run's clock since `sinceS`, ticking ten times a second while the run does. */
import { Text } from '@mantine/core'
import { useEffect, useState } from 'react'
import { useLiveStore, type LiveStore } from '../api/liveStore'
import { duration } from '../document/time'

function clockOf({ nowS, ticking, atMs }: LiveStore): number {
  return ticking ? nowS + (performance.now() - atMs) / 1000 : nowS
}

export function Elapsed({ sinceS }: { sinceS: number }) {
  const store = useLiveStore()
  const [now, setNow] = useState(() => clockOf(store.getState()))
  useEffect(() => {
    const timer = setInterval(() => setNow(clockOf(store.getState())), 100)
    return () => clearInterval(timer)
  }, [store])
  return <TimeText>{duration(Math.max(0, now - sinceS))}</TimeText>
}

/** A time whose digits stay where they are while it goes on. */
export function TimeText({ children }: { readonly children: string }) {
  return (
    <Text span inherit style={{ fontVariantNumeric: 'tabular-nums', whiteSpace: 'nowrap' }}>
      {children}
    </Text>
  )
}

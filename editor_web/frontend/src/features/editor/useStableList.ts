/** A list whose elements stay the same objects as long as they look the same. */
import { useMemo, useRef } from 'react'
import { shareUnchanged } from './structuralSharing'

export function useStableList<T extends { readonly id: string }>(now: readonly T[]): readonly T[] {
  const before = useRef<readonly T[]>([])
  return useMemo(() => (before.current = shareUnchanged(before.current, now)), [now])
}

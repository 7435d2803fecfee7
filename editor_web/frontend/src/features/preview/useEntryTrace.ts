/** What is known of a named entry, and where an arm would be along it; asked for anew when the store changes. */
import { useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
import { entries } from '../../api/entries'
import { teach, useTeach } from '../../api/teaching'
import type { EntryChanged, Trace } from '../../api/types'

// Who goes through a list looks at none of what is between.
const POINTING_MS = 120

export interface EntryTrace {
  readonly row?: EntryChanged | undefined
  readonly trace?: Trace | undefined
  readonly problem: string
}

const WAITING: EntryTrace = { problem: '' }

/** Nothing is asked without a name; without an arm only what is known of the entry. */
export function useEntryTrace(kind: string, name: string, arm: string): EntryTrace {
  const changed = useTeach((s) => s.entries)
  const of = JSON.stringify([kind, name, arm])
  const [known, setKnown] = useState<EntryTrace & { readonly of: string }>()
  useEffect(() => {
    if (!name) return
    let isCurrent = true
    const keep = (found: Partial<EntryTrace>) =>
      isCurrent && setKnown((before) => ({ ...(before?.of === of ? before : WAITING), ...found, of }))
    const fail = (error: unknown) => keep({ trace: undefined, problem: wordsOf(error) })
    const asked = setTimeout(() => {
      entries.row(kind, name).then((row) => keep({ row }), fail)
      if (arm)
        teach
          .fits(arm, { kind, name, capture: 0 })
          .then((fits) => keep({ trace: fits.demonstration ?? fits.primitive ?? undefined, problem: '' }), fail)
    }, POINTING_MS)
    return () => {
      isCurrent = false
      clearTimeout(asked)
    }
  }, [kind, name, arm, of, changed])
  return known?.of === of ? known : WAITING
}

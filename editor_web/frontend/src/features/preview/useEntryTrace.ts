/** What is known of a named entry, and where an arm would be along it; asked for anew when the store changes. */
import { useDebouncedValue } from '@mantine/hooks'
import { entryQueries } from '../../api/entries'
import { useAnswer } from '../../api/queryClient'
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
  const of = JSON.stringify([kind, name, arm])
  const [pointedAt] = useDebouncedValue(of, POINTING_MS)
  const isAsked = name !== '' && pointedAt === of
  const row = useAnswer({ ...entryQueries.row(kind, name), enabled: isAsked })
  const fits = useAnswer({ ...entryQueries.fits(arm, { kind, name, capture: 0 }), enabled: isAsked && arm !== '' })
  if (!isAsked) return WAITING
  const problem = row.problem ?? fits.problem
  if (problem !== undefined) return { row: row.value ?? undefined, problem }
  return { row: row.value ?? undefined, trace: fits.value?.demonstration ?? fits.value?.primitive ?? undefined, problem: '' }
}

/** Named entries of the cell's store: who changed one last, and what is in it. */
import { queryOptions } from '@tanstack/react-query'
import type { Dict } from '../document/dict'
import { call, post } from './client'
import { queryKeys } from './queryKeys'
import { teach, type TaughtReference } from './teaching'
import type { EntryChanged, EntryPage, EntryRecord } from './types'

export const entries = {
  /** The entry with its last change; undefined where there is none. */
  row: async (kind: string, name: string): Promise<EntryChanged | undefined> => {
    const page = await call<EntryPage>(`/teach/entries?${new URLSearchParams({ kind, text: name }).toString()}`)
    return page.entries.find((entry) => entry.name === name)
  },
  /** For those who may call services. */
  value: async (kind: string, name: string): Promise<Dict<unknown>> => {
    const record = await post<EntryRecord>('/bus/call', {
      address: 'store/read_entry',
      request: { kind, name },
    })
    return record.value
  },
}

export const entryQueries = {
  found: (kind: string, text: string) =>
    queryOptions({ queryKey: queryKeys.entriesFound(kind, text), queryFn: () => teach.entries(kind, text) }),
  /** Null where there is none. */
  row: (kind: string, name: string) =>
    queryOptions({ queryKey: queryKeys.entry(kind, name), queryFn: async () => (await entries.row(kind, name)) ?? null }),
  value: (kind: string, name: string) =>
    queryOptions({ queryKey: queryKeys.entryValue(kind, name), queryFn: () => entries.value(kind, name) }),
  history: (kind: string, name: string) =>
    queryOptions({ queryKey: queryKeys.entryHistory(kind, name), queryFn: () => teach.history(kind, name) }),
  /** A revision stays what it is. */
  revision: (kind: string, name: string, revision: number) =>
    queryOptions({
      queryKey: queryKeys.revision(kind, name, revision),
      queryFn: () => teach.revision(kind, name, revision),
      staleTime: Infinity,
    }),
  /** Where an arm would be along something. */
  fits: (arm: string, what: TaughtReference) => queryOptions({ queryKey: queryKeys.fits(arm, what), queryFn: () => teach.fits(arm, what) }),
  capture: (id: number) => queryOptions({ queryKey: queryKeys.capture(id), queryFn: () => teach.capture(id) }),
}

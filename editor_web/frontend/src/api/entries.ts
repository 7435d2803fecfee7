/** Named entries of the cell's store: who changed one last, and what is in it. */
import type { Dict } from '../document/dict'
import { call, post } from './client'
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

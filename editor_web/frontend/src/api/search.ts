/** What the search of the page offers: the commands of the page that is shown, and what the server finds by name. */
import { queryOptions } from '@tanstack/react-query'
import { call } from './client'
import { queryKeys } from './queryKeys'
import type { NameHit } from './types'
import { pageStore } from './pageStore'

export interface PageCommand {
  readonly id: string
  readonly title: string
  readonly group: string
  readonly detail?: string | undefined
  /** The name of the icon of a node; a command without one has that of all commands. */
  readonly icon?: string
  /** Its key, as it is written on keyboards. */
  readonly hint?: string | undefined
  /** Why it cannot be used now. */
  readonly obstacle?: string | undefined
  readonly run: () => void
}

interface SearchStore {
  readonly isOpen: boolean
  /** Returns the commands of the page that is shown, as they are now. */
  readonly commands: () => readonly PageCommand[]
}

const none = (): readonly PageCommand[] => []

export const useSearch = pageStore<SearchStore>(() => ({ isOpen: false, commands: none }))

export function openSearch(): void {
  useSearch.setState({ isOpen: true })
}

export function closeSearch(): void {
  useSearch.setState({ isOpen: false })
}

/** Offer the commands of a page until the returned function is called. */
export function offerCommands(commands: () => readonly PageCommand[]): () => void {
  useSearch.setState({ commands })
  return () => useSearch.setState((now) => (now.commands === commands ? { commands: none } : now))
}

/** The commands of the page that is shown, as they are now. */
export function pageCommands(): readonly PageCommand[] {
  return useSearch.getState().commands()
}

/** Behaviors, nodes, entries and runs whose names have every word of a text, best first. */
export function namesQuery(text: string) {
  return queryOptions({
    queryKey: queryKeys.names(text),
    queryFn: ({ signal }) => call<readonly NameHit[]>(`/search?text=${encodeURIComponent(text)}`, { signal }),
    enabled: text !== '',
  })
}

/** Where the behaviors of the project use something: asked for on any page, and what the server finds. */
import { queryOptions } from '@tanstack/react-query'
import type { Used } from '../document/editing/usedBy'
import { call } from './client'
import { pageStore } from './pageStore'
import { queryKeys } from './queryKeys'
import type { Usages } from './types'

export const useUsages = pageStore<{ readonly asked: Used | undefined }>(() => ({ asked: undefined }))

export function findUsages(asked: Used | undefined): void {
  useUsages.setState({ asked })
}

export function usagesQuery({ kind, name }: Used) {
  return queryOptions({
    queryKey: queryKeys.usages(kind, name),
    queryFn: () => call<Usages>(`/search/usages?kind=${kind}&name=${encodeURIComponent(name)}`),
    enabled: name !== '',
    // Documents are saved all the time.
    staleTime: 0,
  })
}

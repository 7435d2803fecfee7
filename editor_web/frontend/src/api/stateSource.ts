/** The Python source of a state of the catalogue. */
import { queryOptions } from '@tanstack/react-query'
import { call } from './client'
import { queryKeys } from './queryKeys'
import type { StateSource } from './types'

export function stateSourceQuery(state: string) {
  return queryOptions({
    queryKey: queryKeys.stateSource(state),
    queryFn: () => call<StateSource>(`/catalogue/states/${encodeURIComponent(state)}/source`),
    retry: false,
  })
}

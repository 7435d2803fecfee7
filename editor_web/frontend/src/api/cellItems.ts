/** What the open cell consists of. */
import { queryOptions } from '@tanstack/react-query'
import { call } from './client'
import { queryKeys } from './queryKeys'
import type { CellItems } from './types'

export function cellItemsQuery() {
  return queryOptions({ queryKey: queryKeys.cellItems, queryFn: () => call<CellItems>('/cell/items') })
}

/** Everything that a behavior can use: states, behaviors, entries, and the names of the open cell. */
import { queryOptions } from '@tanstack/react-query'
import { documents } from './documents'
import { queryKeys } from './queryKeys'

export const catalogueQuery = () => queryOptions({ queryKey: queryKeys.catalogue, queryFn: documents.catalogue })

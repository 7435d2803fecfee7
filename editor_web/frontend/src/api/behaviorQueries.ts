/** What is asked about the behaviors of the project and their runs. */
import { queryOptions } from '@tanstack/react-query'
import { api } from './client'
import { queryKeys } from './queryKeys'

export const behaviorQueries = {
  all: () => queryOptions({ queryKey: queryKeys.behaviors, queryFn: api.behaviors }),
  one: (id: string) => queryOptions({ queryKey: queryKeys.behavior(id), queryFn: () => api.behavior(id) }),
  interrupted: () => queryOptions({ queryKey: queryKeys.interrupted, queryFn: api.interrupted }),
  /** A form begins with it: what was told when the form was open before is not taken again. */
  startData: (behavior: string, path: string) =>
    queryOptions({ queryKey: queryKeys.startData(behavior, path), queryFn: () => api.startData(behavior, path), gcTime: 0 }),
}

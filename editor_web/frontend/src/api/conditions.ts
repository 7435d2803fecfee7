/** What the engine says of the condition of a breakpoint while it is typed: what is wrong with it, and which names it can use. */
import { queryOptions } from '@tanstack/react-query'
import { addressOf } from '../document/path'
import { post } from './client'
import { queryKeys } from './queryKeys'
import type { Breakpoint, ConditionCheck } from './types'

export function conditionQuery(behavior: string, point: Breakpoint) {
  return queryOptions({
    queryKey: queryKeys.condition(behavior, point),
    queryFn: () => post<ConditionCheck>(`/breakpoints/${addressOf(behavior)}/condition`, point),
    enabled: behavior !== '',
  })
}

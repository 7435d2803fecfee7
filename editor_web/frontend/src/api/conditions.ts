/** What the engine says of the condition of a breakpoint while it is typed: what is wrong with it, and which names it can use. */
import { queryOptions } from '@tanstack/react-query'
import { addressOf } from '../document/path'
import { post } from './client'
import { queryKeys } from './queryKeys'
import type { ConditionBody, ConditionCheck } from './types'

export function conditionQuery(behavior: string, body: ConditionBody) {
  return queryOptions({
    queryKey: queryKeys.condition(behavior, body),
    queryFn: () => post<ConditionCheck>(`/breakpoints/${addressOf(behavior)}/condition`, body),
    enabled: behavior !== '',
  })
}

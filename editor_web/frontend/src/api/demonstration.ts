/** From demonstration to behavior, over HTTP. */
import { queryOptions } from '@tanstack/react-query'
import { post } from './client'
import { queryKeys } from './queryKeys'
import type { DemonstrationBody, ProposalBody } from './types'

/** Propose a behavior; with an `id` it is written as a new document. */
export function propose(body: DemonstrationBody): Promise<ProposalBody> {
  return post<ProposalBody>('/teach/proposal', body)
}

export function proposalQuery(body: DemonstrationBody) {
  return queryOptions({ queryKey: queryKeys.proposal(body), queryFn: () => propose(body) })
}

/** From demonstration to behavior, over HTTP. */
import { post } from './client'
import type { DemonstrationBody, ProposalBody } from './types'

/** Propose a behavior; with an `id` it is written as a new document. */
export function propose(body: DemonstrationBody): Promise<ProposalBody> {
  return post<ProposalBody>('/teach/proposal', body)
}

/** Adapting a behavior of another cell to the connected one. */
import { queryOptions } from '@tanstack/react-query'
import { post } from './client'
import { queryKeys } from './queryKeys'
import type { AdaptationBody, AdaptationRequest, DocumentBody } from './types'
import { addressOf } from '../document/path'

/** What names become, by `kind:name`; an empty one stays as it is, others are proposed. */
export type NameChoices = Readonly<Record<string, string>>

export const adaptation = {
  plan: (id: string, names: NameChoices) => post<AdaptationBody>(`/documents/${addressOf(id)}/adaptation`, { names }),
  write: (id: string, body: AdaptationRequest) => post<DocumentBody>(`/documents/${addressOf(id)}/adapt`, body),
}

export const adaptationQuery = (id: string, names: NameChoices) =>
  queryOptions({ queryKey: queryKeys.adaptation(id, names), queryFn: () => adaptation.plan(id, names) })

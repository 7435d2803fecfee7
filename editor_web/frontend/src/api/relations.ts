/** Around a document: data flow, fixes of findings, versions, who refers to it, moving, deleting and restoring. */
import { queryOptions } from '@tanstack/react-query'
import { call, post } from './client'
import { queryKeys } from './queryKeys'
import type {
  DeletedDocumentBody,
  DocumentDiff,
  DocumentBody,
  DocumentAnalysis,
  FixesBody,
  KeyFlow,
  MoveResultBody,
  ReferringBehavior,
  VersionBody,
  VersionTextBody,
} from './types'
import { addressOf } from '../document/path'

function at(id: string, rest = ''): string {
  return `/documents/${addressOf(id)}${rest}`
}

export const relations = {
  dataFlow: (id: string, text: string) => post<readonly KeyFlow[]>(at(id, '/data_flow'), { text }),
  fixes: (id: string, text: string) => post<readonly FixesBody[]>(at(id, '/fixes'), { text }),
  versions: (id: string) => call<readonly VersionBody[]>(at(id, '/versions')),
  version: (id: string, hash: string) => call<VersionTextBody>(at(id, `/versions/${hash}`)),
  drawn: (id: string, hash: string) => call<DocumentAnalysis>(at(id, `/versions/${hash}/drawn`)),
  difference: (id: string, from: string, to: string) => call<DocumentDiff>(at(id, `/diff?from=${from}&to=${to}`)),
  compare: (id: string, before: string, after: string) => post<DocumentDiff>(at(id, '/compare'), { before, after }),
  referrers: (id: string) => call<readonly ReferringBehavior[]>(at(id, '/referrers')),
  move: (id: string, to: string, follow: boolean) => post<MoveResultBody>(at(id, '/move'), { id: to, follow }),
  duplicate: (id: string, to: string) => post<DocumentBody>(at(id, '/duplicate'), { id: to }),
  remove: (id: string) => call<void>(at(id), { method: 'DELETE' }),
  deleted: () => call<readonly DeletedDocumentBody[]>('/deleted_documents'),
  restore: (id: string) => post<DocumentBody>(at(id, '/restore'), {}),
}

export const relationQueries = {
  versions: (id: string) => queryOptions({ queryKey: queryKeys.versions(id), queryFn: () => relations.versions(id) }),
  referrers: (id: string) => queryOptions({ queryKey: queryKeys.referrersOf(id), queryFn: () => relations.referrers(id) }),
  deleted: () => queryOptions({ queryKey: queryKeys.deleted, queryFn: relations.deleted }),
}

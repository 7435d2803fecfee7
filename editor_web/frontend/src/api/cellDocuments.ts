/** Editing of cells over HTTP: the documents of the cell and its modules, edits of their texts, and saving. */
import { queryOptions } from '@tanstack/react-query'
import { addressOf } from '../document/path'
import { call, post, sent } from './client'
import { queryKeys } from './queryKeys'
import type {
  CellDocumentBody,
  CellDocumentName,
  CellDraft,
  CellEditAnswer,
  CellEditsBody,
  ModelNames,
  ReferringBehavior,
  SaveResultBody,
  TargetFindingsBody,
} from './types'

function at(id: string, rest = ''): string {
  return `/cell_documents/${addressOf(id)}${rest}`
}

export type CellEdit = CellEditsBody['edits'][number]

export const cellDocuments = {
  open: (id: string) => call<CellDocumentBody>(at(id)),
  draft: (id: string, text: string) => post<CellDraft>(at(id, '/draft'), { text }),
  edit: (id: string, text: string, edits: readonly CellEdit[]) => post<CellEditAnswer>(at(id, '/edits'), { text, edits }),
  rest: (id: string, text: string, page: string) => post<TargetFindingsBody>(at(id, '/rest'), { text, page }),
  save: (id: string, text: string, baseHash: string) => sent<SaveResultBody>('PUT', at(id), { text, base_hash: baseHash }),
}

/** What can be edited: the cell first, where it is in the project, and the modules. */
export function cellDocumentsQuery(mayEdit: boolean) {
  return queryOptions({
    queryKey: queryKeys.cellDocuments,
    queryFn: () => call<readonly CellDocumentName[]>('/cell_documents'),
    enabled: mayEdit,
  })
}

/** The models of robots and tools that a cell may name. */
export function modelNamesQuery(isEdited: boolean) {
  return queryOptions({ queryKey: queryKeys.cellModels, queryFn: () => call<ModelNames>('/cell/models'), enabled: isEdited })
}

/** The saved behaviors that name an item of the open cell; asked for where there is a name. */
export function namingBehaviorsQuery(name: string) {
  return queryOptions({
    queryKey: queryKeys.namingBehaviors(name),
    queryFn: () => call<readonly ReferringBehavior[]>(`/cell/naming_behaviors?name=${encodeURIComponent(name)}`),
    enabled: name !== '',
    // Behaviors are saved all the time.
    staleTime: 0,
  })
}

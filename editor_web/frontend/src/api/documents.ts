/** Editing over HTTP: documents, drafts, edits of texts, saving, and what can be put into a behavior. */
import { call, post, postForFile, sent, ServerError } from './client'
import type {
  CatalogueBody,
  ConflictBody,
  CopyResultBody,
  DocumentBody,
  DocumentAnalysis,
  Edit,
  EditAnswer,
  FindingView,
  NewDocumentBody,
  NodeConflict,
  SaveResultBody,
  TargetFindingsBody,
} from './types'
import { addressOf } from '../document/path'

/** The side to take for a conflict, by its path and field. */
export type MergeSides = Readonly<Record<string, NodeConflict['side']>>

function at(id: string, rest = ''): string {
  return `/documents/${addressOf(id)}${rest}`
}

export const documents = {
  /** Drawn, not checked yet: `findings` follow, as after `draft`. */
  open: (id: string) => call<DocumentBody>(at(id, '?check=false')),
  openChecked: (id: string) => call<DocumentBody>(at(id)),
  make: (body: NewDocumentBody) => post<DocumentBody>('/documents', body),
  draft: (id: string, text: string) => post<DocumentAnalysis>(at(id, '/draft'), { text, check: false }),
  findings: (id: string, text: string) => post<readonly FindingView[]>(at(id, '/findings'), { text }),
  targets: (id: string, text: string, page: string) => post<TargetFindingsBody>(at(id, '/targets'), { text, page }),
  names: (id: string, text: string) => post<CatalogueBody['names']>(at(id, '/names'), { text }),
  /** `graph` is the hash of the text whose graph is there already: only the difference from it comes. */
  edit: (id: string, text: string, edits: readonly Edit[], { check, graph }: { readonly check: boolean; readonly graph: string | null }) =>
    post<EditAnswer>(at(id, '/edits'), { text, edits, check, graph }),
  copy: (id: string, text: string, paths: readonly string[]) => post<CopyResultBody>(at(id, '/copy'), { text, paths }),
  /** The drawing of a document as a PDF, made of its SVG. */
  pdf: (id: string, svg: string) => postForFile(at(id, '/pdf'), { svg }),
  save: (id: string, text: string, baseHash: string) => sent<SaveResultBody>('PUT', at(id), { text, base_hash: baseHash }),
  /** What a save would meet, merged with these sides; nothing is written. */
  merge: (id: string, text: string, baseHash: string, sides: MergeSides) =>
    post<ConflictBody>(at(id, '/merge'), { text, base_hash: baseHash, sides }),
  catalogue: () => call<CatalogueBody>('/catalogue'),
}

/** What stands on disk instead, when saving was refused because of it. */
export function conflictOf(error: unknown): ConflictBody | undefined {
  return error instanceof ServerError && error.status === 409 ? (error.answer as ConflictBody) : undefined
}

/** A document that is open in the editor: what the server tells of it, and the edits that the page sends. */
import type { CatalogueBody, DocumentInfo, DocumentNode, Edit, EditAnswer } from '../src/api/types.ts'
import { newHistory } from '../src/document/editing/history.ts'
import { draftFrom } from '../src/features/editor/apply.ts'
import { blank, setEditor, useEditor } from '../src/features/editor/store.ts'
import { live, server, session } from './page.tsx'

const ID = 'behaviors/shift.yaml'

/** Where the page sends edits of the open document. */
export const EDITS = `POST /documents/${ID}/edits`

/** What the open document is, beside its nodes. */
export const INFO: DocumentInfo = {
  name: 'shift',
  description: '',
  cell: null,
  parameters: {},
  userdata: {},
  outcomes: ['good', 'bad'],
  success: ['good'],
}

/** What the server answers to an edit after which the document has this root. */
export function edited(root: DocumentNode, more: Partial<EditAnswer> = {}): EditAnswer {
  return {
    hash: 'h2',
    graph: root,
    document: INFO,
    findings: [],
    checked: true,
    text: `${Math.random()}`,
    changed: [],
    refused: null,
    difference: null,
    ...more,
  }
}

/** Open a document with this root in the editor; its edits are answered with `answer`. */
export function openDocument(root: DocumentNode, { catalogue, answer }: { catalogue?: CatalogueBody; answer?: EditAnswer } = {}): void {
  server()
    .on('GET /session', session())
    .on(EDITS, answer ?? edited(root))
    .on(`POST /documents/${ID}/findings`, [])
    .on(`POST /documents/${ID}/targets`, { findings: [], dropped: false, problem: '' })
  live()
  useEditor.setState(blank(ID), true)
  const draft = draftFrom({ hash: 'h1', graph: root, findings: [], checked: true, document: INFO }, 'one', undefined)
  const kinds = catalogue ? { catalogue } : {}
  setEditor({ phase: 'ready', base: { text: 'one', hash: 'h1' }, history: newHistory(draft), ...kinds })
}

/** The edits that the page has sent, one list for each request. */
export function sentEdits(): Edit[][] {
  return (server().bodies(EDITS) as { edits: Edit[] }[]).map((body) => body.edits)
}

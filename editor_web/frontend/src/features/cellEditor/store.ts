/** What the editor of the cell holds: the document under edit with its history, and what the server last refused. */
import type { CellDraft, ConflictBody, FindingView } from '../../api/types'
import { pageStore } from '../../api/pageStore'
import type { DragSteps } from '../../document/cellPlacing'
import { newHistory, presentOf, type History } from '../../document/editing/history'

/** A draft; one that was just typed has still the items of the text before. */
export interface CellText extends CellDraft {
  readonly isStale?: boolean
}

export interface CellEditorState {
  readonly phase: 'closed' | 'loading' | 'ready' | 'failed'
  readonly id: string
  readonly problem: string
  /** The file as it is on disk, as far as this page knows. */
  readonly base: { readonly text: string; readonly hash: string }
  readonly history: History<CellText>
  readonly isBusy: boolean
  readonly notice: { readonly what: string; readonly message: string; readonly hint: string } | undefined
  readonly conflict: ConflictBody | undefined
  /** What touches in the draft while everything is at rest; of the text before until the new one was looked at. */
  readonly rest: readonly FindingView[]
  /** The steps of drags in the 3D view. */
  readonly steps: DragSteps
}

const NOTHING: CellText = { text: '', hash: '', kind: 'cell', items: [], findings: [], frames: {}, parts: {}, positions: {} }

export function blank(): CellEditorState {
  return {
    phase: 'closed',
    id: '',
    problem: '',
    base: { text: '', hash: '' },
    history: newHistory(NOTHING),
    isBusy: false,
    notice: undefined,
    conflict: undefined,
    rest: [],
    steps: 'off',
  }
}

export const useCellEditor = pageStore<CellEditorState>(blank)

export const cellEditor = useCellEditor.getState

export function setCellEditor(change: Partial<CellEditorState>): void {
  useCellEditor.setState(change)
}

export function draftOf(state: CellEditorState): CellText {
  return presentOf(state.history).draft
}

export function isDirty(state: CellEditorState): boolean {
  return state.phase === 'ready' && draftOf(state).text !== state.base.text
}

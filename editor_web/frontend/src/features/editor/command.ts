/** A command of the editor: its row in the table of commands, what it needs, and what it does. */
import type { CommandRow, EditorCommandId } from '../../document/commandTable'

export interface Action {
  /** What is needed for it; nothing stands in the way without. */
  readonly needs?: 'node' | 'nodes' | 'undo' | 'redo' | 'changes'
  readonly run: () => void
}

export type Command = Action & Pick<CommandRow, 'words' | 'part'> & { readonly id: EditorCommandId }

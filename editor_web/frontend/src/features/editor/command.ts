/** A command of the editor: its words, its keys, and what it needs. */
import type { Chord } from '../../document/editing/keys'

export interface Command {
  readonly id: string
  readonly words: string
  readonly part: 'Document' | 'Build' | 'Arrange' | 'Move around'
  readonly chords: readonly Chord[]
  /** What is needed for it; nothing stands in the way without. */
  readonly needs?: 'node' | 'nodes' | 'undo' | 'redo' | 'changes'
  readonly run: () => void
}

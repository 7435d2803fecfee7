/** What can stand inside `${…}` at a place, and how a choice is put into the text. Pure. */
import { found } from './search'

export interface Name {
  readonly name: string
  /** `parameter`, `userdata`. */
  readonly origin: string
  readonly detail: string
}

export interface Opening {
  /** Where the word under the cursor begins. */
  readonly from: number
  readonly word: string
  readonly names: readonly Name[]
}

/** Names that fit the word before the cursor, when the cursor is inside `${…}`; undefined elsewhere. */
export function openingAt(text: string, cursor: number, names: readonly Name[]): Opening | undefined {
  const before = text.slice(0, cursor)
  const start = before.lastIndexOf('${')
  if (start < 0 || before.indexOf('}', start) >= 0) return undefined
  const word = /[A-Za-z_][A-Za-z0-9_]*$/.exec(before)?.[0] ?? ''
  return { from: cursor - word.length, word, names: found(names, word, (name) => [name.name]) }
}

/** The text and cursor after choosing a name; `}` is added where it is missing. */
export function completed(
  text: string,
  cursor: number,
  opening: Opening,
  name: string,
): { readonly text: string; readonly cursor: number } {
  const rest = text.slice(cursor)
  const isClosed = /^[^${]*\}/.test(rest)
  const filled = text.slice(0, opening.from) + name
  return { text: filled + (isClosed ? '' : '}') + rest, cursor: filled.length + (isClosed ? 0 : 1) }
}

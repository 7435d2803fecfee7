/** The people on other pages in words. Pure. */
import type { Presence } from '../api/types'
import { nameOfPath } from './path'

/** The first letters of at most two words. */
export function initialsOf(name: string): string {
  const letters = name
    .trim()
    .split(/\s+/)
    .map((word) => String.fromCodePoint(word.codePointAt(0) ?? 32).trim())
  return letters.slice(0, 2).join('').toUpperCase()
}

/** What a page shows. */
export function placeWords({ document, node, edits, role }: Presence): string {
  if (document === '') return role === 'operator' ? 'May operate' : 'Looks only'
  const file = nameOfPath(document)
  return `${edits ? 'Edits' : 'Shows'} ${file}${node ? `, ${nameOfPath(node)} selected` : ''}`
}
